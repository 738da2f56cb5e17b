// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_tracer.hpp"

#include <algorithm>

namespace viewgain::detail {
namespace {

constexpr double kMaxPoseError = 1e-3;
constexpr double kMendPoseError = 1e-9;

}  // namespace

ViewTracer::ViewTracer(const VoxelScene::Data& scene, const PinholeCamera& camera, int pixel_stride,
                       double min_range, double max_range)
    : scene_(scene),
      table_(camera, pixel_stride),
      binner_(camera, pixel_stride, table_),
      T_grid_world_(scene.snapshot.T_world_grid.inverse()),
      min_range_(min_range),
      max_range_(max_range) {
  if (scene.has_obstacles || camera.has_distortion()) scene.ensure_bvh();
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
  // Embree's rays have finite ends; all of the workspace is nearer than this.
  const double end = 4 * kFarthestCamera;
  frame.sees_nothing =
      !(origin.cwiseAbs().maxCoeff() <= kFarthestCamera) || min_range_ / voxel >= end;
  frame.min_range = static_cast<float>(min_range_ / voxel);
  frame.max_range = static_cast<float>(std::min(max_range_ / voxel, end));
  return frame;
}

}  // namespace viewgain::detail
