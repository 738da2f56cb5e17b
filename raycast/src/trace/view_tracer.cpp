// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_tracer.hpp"

#include <algorithm>
#include <utility>

namespace viewgain::detail {
namespace {

constexpr double kMaxPoseError = 1e-3;
constexpr double kMendPoseError = 1e-9;
// Embree's rays have finite ends; all of the workspace is nearer than this [voxels].
constexpr double kRayEnd = 4 * kFarthestCamera;

}  // namespace

ViewTracer::ViewTracer(const SceneData& scene, std::shared_ptr<const SensorRays> rays,
                       double min_range, double max_range)
    : scene_(scene),
      kernels_(scene.tracing->kernels),
      rays_(std::move(rays)),
      T_grid_world_(scene.snapshot.T_world_grid.inverse()) {
  const double voxel = scene.snapshot.voxel_size;
  const double nearest = min_range / voxel, farthest = std::min(max_range / voxel, kRayEnd);
  min_range_ = static_cast<float>(nearest);
  max_range_ = static_cast<float>(farthest);
  is_out_of_range_ = nearest >= kRayEnd;
  choice_ = choose_tracing(scene, *rays_, farthest);
  if (!choice_.by_lists) (void)scene.tracing->bvh(choice_.margin_level);
}

std::optional<PoseFrame> ViewTracer::frame_of(const Pose& T_world_camera) const {
  const double error = orthonormality_error(T_world_camera);
  if (!(error <= kMaxPoseError)) return std::nullopt;
  const Pose T_grid_camera =
      T_grid_world_ * (error <= kMendPoseError ? T_world_camera : orthonormalized(T_world_camera));
  const double voxel = scene_.snapshot.voxel_size;
  const Index3& base = scene_.snapshot.min_index;
  const Eigen::Vector3d origin =
      T_grid_camera.translation() / voxel - Eigen::Vector3d(base.x, base.y, base.z);
  const Eigen::Matrix3d R = T_grid_camera.rotation();
  PoseFrame frame;
  for (int r = 0; r < 3; ++r) {
    frame.origin[static_cast<std::size_t>(r)] = static_cast<float>(origin[r]);
    for (int c = 0; c < 3; ++c) {
      frame.rotation[static_cast<std::size_t>(3 * r + c)] = static_cast<float>(R(r, c));
    }
  }
  frame.sees_nothing = !(origin.cwiseAbs().maxCoeff() <= kFarthestCamera) || is_out_of_range_;
  frame.min_range = min_range_;
  frame.max_range = max_range_;
  frame.extra_margin = margin_of(choice_.margin_level) - margin_of(0);
  return frame;
}

}  // namespace viewgain::detail
