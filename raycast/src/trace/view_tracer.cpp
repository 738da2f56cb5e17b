// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_tracer.hpp"

#include <bit>

#include "cell_sweep.hpp"
#include "voxel_bvh.hpp"

namespace viewgain::detail {
namespace {

// Embree's rays have finite ends; all of the workspace is nearer than this [voxels].
constexpr double kRayEnd = 4 * kFarthestCamera;

}  // namespace

ViewTracer::ViewTracer(const SceneData& scene, std::shared_ptr<const SensorRays> rays,
                       double min_range, double max_range, ExecConfig::Tracer tracer)
    : scene_(scene),
      kernels_(scene.tracing->kernels),
      rays_(std::move(rays)),
      tracer_(tracer),
      T_grid_world_(scene.snapshot.T_world_grid.inverse()) {
  const double voxel = scene.snapshot.voxel_size;
  const double nearest = min_range / voxel, farthest = std::min(max_range / voxel, kRayEnd);
  min_range_ = static_cast<float>(nearest);
  max_range_ = static_cast<float>(farthest);
  is_out_of_range_ = nearest >= kRayEnd;
  // A camera that sees anything is no farther than its range from the workspace.
  const Index3& dims = scene.snapshot.dims;
  margin_level_ = margin_level(farthest + std::max({dims.x, dims.y, dims.z}));
  if (tracer == ExecConfig::Tracer::embree) (void)scene.tracing->bvh(margin_level_);
}

std::optional<PoseFrame> ViewTracer::frame_of(const Pose& T_world_camera) const {
  const std::optional<Pose> T_rigid = rigid_pose(T_world_camera);
  if (!T_rigid) return std::nullopt;
  const Pose T_grid_camera = T_grid_world_ * *T_rigid;
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
  frame.extra_margin = margin_of(margin_level_) - margin_of(0);
  return frame;
}

void ViewTracer::prepare(const PoseFrame& frame, ViewSweep& sweep, Asked asked) const {
  sweep.obstacles.clear();
  sweep.near.clear();
  if (frame.sees_nothing) return;
  find_near(frame, sweep.near);
  sweep.by_bvh = tracer_ == ExecConfig::Tracer::embree ||
                 (tracer_ == ExecConfig::Tracer::automatic &&
                  scene_.tracing->takes_bvh(table().ray_count(), margin_level_));
  const ObstacleScene* obstacles = scene_.tracing->obstacles.get();
  if (!sweep.by_bvh) {
    const ImageBoundsKernels& kernels = image_bounds_kernels(kernels_.isa);
    sweep.see(kernels, *scene_.cells, frame, rays_->projector.scale_for(frame, frame.min_range));
    if (obstacles == nullptr) return;
    sweep.obstacles.mark(kernels, *obstacles, frame, rays_->projector.scale_for(frame, 0),
                         rays_->table, asked != Asked::everywhere);
  } else if (obstacles != nullptr) {
    sweep.obstacles.expect(rays_->table.tile_count);
  }
}

void ViewTracer::find_near(const PoseFrame& frame, NearSurface& near) const {
  near.find(image_bounds_kernels(kernels_.isa), scene_, frame, rays_->projector.scale_for(frame, 0),
            rays_->table);
}

// Sets a tile up for a view, and cuts its rays at obstacles that are asked for before voxels: rays
// that end early meet fewer.
class ViewTracer::SetUp final : public TileMaker {
 public:
  SetUp(const ViewTracer& tracer, const PoseFrame& frame, Asked asked, const ViewSweep& sweep)
      : tracer_(tracer), frame_(frame), asked_(asked), sweep_(sweep) {}

  std::uint32_t make(std::size_t tile, float near_voxel, RayTile& out) const override {
    tracer_.begin(frame_, tile, sweep_.near, out);
    const std::uint32_t ended = out.blocked;
    const ObstacleMarks& obstacles = sweep_.obstacles;
    const float near = obstacles.near(tile);
    if (near == ObstacleMarks::kNoObstacle) return ended;
    if (asked_ == Asked::everywhere || (near <= obstacles.farthest_voxel() &&
                                        (asked_ == Asked::along_rays || near <= near_voxel))) {
      tracer_.ask_first(frame_, out);
    }
    return ended;
  }

 private:
  const ViewTracer& tracer_;
  const PoseFrame& frame_;
  Asked asked_;
  const ViewSweep& sweep_;
};

void ViewTracer::sweep_strip(const PoseFrame& frame, TileRows strip, Asked asked,
                             ViewSweep& sweep) const {
  const SetUp maker(*this, frame, asked, sweep);
  StripRays& rays = sweep.strip;
  rays.begin(rays_->table, strip, maker);
  if (sweep.by_bvh) return;
  if (asked == Asked::everywhere) {
    for (std::size_t i = 0; i < rays.tile_count(); ++i) {
      const std::size_t tile = rays.first_tile() + i;
      if (sweep.obstacles.near(tile) != ObstacleMarks::kNoObstacle) (void)rays.meet(i, 0);
      sweep.near.for_each_at(tile, [&](const auto&) { (void)rays.meet(i, 0); });
    }
  }
  const CellSweep sweep_cell = cell_sweep(kernels_.isa);
  const ImageScale image = rays_->projector.scale_for(frame, frame.min_range);
  for (const SeenCell& cell : sweep.seen) {
    sweep_cell(scene_, cell, frame, image, sweep.camera_block, rays);
  }
}

void ViewTracer::finish(const PoseFrame& frame, std::size_t tile, const ViewSweep& sweep,
                        RayTile& rays) const {
  if (sweep.by_bvh) {
    begin(frame, tile, sweep.near, rays);
    if (scene_.has_obstacles) ask_first(frame, rays);
    packet_kernels(kernels_.isa).trace(scene_, scene_.tracing->bvh(margin_level_), frame, rays);
  } else if (scene_.has_obstacles && !rays.has_far) {
    ask_afterwards(frame, tile, sweep.obstacles.near(tile), rays);
  }
  rays.blocked &= ~rays.hit;
}

void ViewTracer::ask_first(const PoseFrame& frame, RayTile& rays) const {
  std::copy_n(rays.range, kTileRays, rays.far);
  rays.blocked |= scene_.tracing->obstacles->cut(frame, rays, rays.valid, rays.far);
  rays.has_far = true;
  for (std::uint32_t left = rays.blocked; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    rays.range[lane] = rays.far[lane];
    rays.primitive[lane] = kObstaclePrimitive;
  }
}

void ViewTracer::ask_afterwards(const PoseFrame& frame, std::size_t tile, float near,
                                RayTile& rays) const {
  const ObstacleScene& obstacles = *scene_.tracing->obstacles;
  float farthest = 0;
  for (std::uint32_t left = rays.hit; left != 0; left &= left - 1) {
    farthest = std::max(farthest, rays.range[std::countr_zero(left)]);
  }
  farthest += obstacles.rounding();
  if (rays.hit == 0 || near > farthest * rays_->table.cosine[tile]) return;
  // A little farther than the voxels, since an obstacle wins a tie and Embree's distances are
  // rounded.
  alignas(64) float far[kTileRays];
  for (int lane = 0; lane < kTileRays; ++lane) {
    far[lane] = rays.range[lane] * (1.0F + 1e-6F) + obstacles.rounding();
  }
  const std::uint32_t met = obstacles.cut(frame, rays, rays.hit, far);
  for (std::uint32_t left = met; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (far[lane] > rays.range[lane]) continue;
    rays.range[lane] = far[lane];
    rays.primitive[lane] = kObstaclePrimitive;
    rays.blocked |= 1U << lane;
    rays.hit &= ~(1U << lane);
  }
}

}  // namespace viewgain::detail
