// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_tracer.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "obstacle_ranges.hpp"

namespace viewgain::detail {
namespace {

constexpr double kMaxPoseError = 1e-3;
constexpr double kMendPoseError = 1e-9;
// Embree's rays have finite ends; all of the workspace is nearer than this [voxels].
constexpr double kRayEnd = 4 * kFarthestCamera;

}  // namespace

ViewTracer::ViewTracer(const SceneData& scene, std::shared_ptr<const SensorRays> rays,
                       double min_range, double max_range, TraceWay way)
    : scene_(scene),
      kernels_(scene.tracing->kernels),
      rays_(std::move(rays)),
      T_grid_world_(scene.snapshot.T_world_grid.inverse()) {
  const double voxel = scene.snapshot.voxel_size;
  const double nearest = min_range / voxel, farthest = std::min(max_range / voxel, kRayEnd);
  min_range_ = static_cast<float>(nearest);
  max_range_ = static_cast<float>(farthest);
  is_out_of_range_ = nearest >= kRayEnd;
  choice_ = choose_tracing(scene, way, farthest);
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

void ViewTracer::prepare(const PoseFrame& frame, TileBins& bins, Asked asked) const {
  bins.invalidate();
  if (frame.sees_nothing) return;
  const ObstacleScene* obstacles = scene_.tracing->obstacles.get();
  if (choice_.by_lists) {
    rays_->binner.sort(kernels_.isa, *scene_.scene_boxes, frame, bins);
    if (obstacles == nullptr) return;
    rays_->binner.mark_obstacles(kernels_.isa, *obstacles, frame, asked != Asked::everywhere, bins);
  } else if (obstacles != nullptr) {
    bins.expect_obstacles(rays_->table.tile_count);
  }
}

void ViewTracer::trace_voxels(const PoseFrame& frame, std::size_t tile, TileBins& bins,
                              RayTile& out) const {
  if (bins.valid()) {
    trace_lists(frame, tile, bins, out);
  } else {
    kernels_.trace(scene_, scene_.tracing->bvh(choice_.margin_level), frame, out);
  }
}

void ViewTracer::trace_lists(const PoseFrame& frame, std::size_t tile, TileBins& bins,
                             RayTile& out) const {
  const SceneBoxes& scene = *scene_.scene_boxes;
  const float cosine = rays_->table.cosine[tile];
  if (scene.are_primitives()) {
    kernels_.walk(scene_, frame, cosine, bins.boxes_of(tile), out);
    return;
  }
  // The primitives of the next cell are chosen, and asked for, while those of this one are walked.
  float of_interest = std::numeric_limits<float>::max();
  std::span<const TileBox> waiting;
  for (const TileBox& cell : bins.boxes_of(tile)) {
    if (cell.near > of_interest) break;
    const auto primitives =
        rays_->binner.select(kernels_.isa, scene, frame, cell.box, tile, of_interest, bins);
    if (primitives.empty()) continue;
    for (const TileBox& primitive : primitives) {
      __builtin_prefetch(&scene_.boxes[primitive.box]);
      if (primitive.box < scene_.leaf_count) __builtin_prefetch(&scene_.masks[primitive.box]);
    }
    if (!waiting.empty()) of_interest = kernels_.walk(scene_, frame, cosine, waiting, out);
    waiting = primitives;
    bins.keep_selected();
  }
  if (!waiting.empty()) kernels_.walk(scene_, frame, cosine, waiting, out);
}

void ViewTracer::trace_with_obstacles(const PoseFrame& frame, std::size_t tile, Asked asked,
                                      TileBins& bins, RayTile& out) const {
  const ObstacleScene& obstacles = *scene_.tracing->obstacles;
  const float near = bins.obstacle_near(tile);
  const bool comes_first =
      !bins.valid() || (!bins.boxes_of(tile).empty() && near <= bins.boxes_of(tile).front().near);
  const bool is_in_reach = near <= bins.farthest_voxel();
  if (asked == Asked::everywhere || (is_in_reach && (asked == Asked::along_rays || comes_first))) {
    // Rays that end early leave fewer boxes to walk.
    std::copy_n(out.range, kTileRays, out.far);
    out.blocked = cut_at_obstacles(obstacles, frame, out, out.valid, out.far);
    out.has_far = true;
    for (std::uint32_t left = out.blocked; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      out.range[lane] = out.far[lane];
      out.primitive[lane] = kObstaclePrimitive;
    }
    trace_voxels(frame, tile, bins, out);
    out.blocked &= ~out.hit;
    return;
  }
  trace_voxels(frame, tile, bins, out);
  float farthest = 0;
  for (std::uint32_t left = out.hit; left != 0; left &= left - 1) {
    farthest = std::max(farthest, out.range[std::countr_zero(left)]);
  }
  farthest += obstacles.rounding();
  if (out.hit == 0 || near > farthest * rays_->table.cosine[tile]) return;
  // A little farther than the voxels, since an obstacle wins a tie and Embree's distances are
  // rounded.
  alignas(64) float far[kTileRays];
  for (int lane = 0; lane < kTileRays; ++lane) {
    far[lane] = out.range[lane] * (1.0F + 1e-6F) + obstacles.rounding();
  }
  const std::uint32_t met = cut_at_obstacles(obstacles, frame, out, out.hit, far);
  for (std::uint32_t left = met; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (far[lane] > out.range[lane]) continue;
    out.range[lane] = far[lane];
    out.primitive[lane] = kObstaclePrimitive;
    out.blocked |= 1U << lane;
  }
  out.hit &= ~out.blocked;
}

}  // namespace viewgain::detail
