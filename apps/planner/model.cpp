// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "model.hpp"

#include <cmath>
#include <utility>

#include "stopwatch.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {

SurfaceMesh surface_of(const std::vector<FusedPoint>& points, double voxel_size) {
  std::vector<OrientedPoint> oriented;
  oriented.reserve(points.size());
  for (const FusedPoint& point : points) oriented.push_back({point.position, point.toward_free});
  SurfaceConfig config;
  config.spacing = voxel_size;
  return reconstruct_surface(oriented, config);
}

Model::Model(const Sensor& sensor, const ModelConfig& config, const ExecConfig& exec,
             std::shared_ptr<const Truth> truth, StageSeconds& seconds)
    : sensor_(sensor),
      config_(config),
      exec_(exec),
      truth_(std::move(truth)),
      seconds_(seconds),
      grid_(config.grid),
      integrator_(sensor, config.integration, exec) {
  if (config.jump_edges) filter_.emplace(sensor.camera, *config.jump_edges);
}

Model::Model(BeliefGrid grid, const Sensor& sensor, const ModelConfig& config,
             const ExecConfig& exec, StageSeconds& seconds)
    : sensor_(sensor),
      config_(config),
      exec_(exec),
      seconds_(seconds),
      grid_(std::move(grid)),
      integrator_(sensor, config.integration, exec) {
  derive();
}

void Model::drop_known_readings(DepthFrame& frame, const Pose& T_world_camera) const {
  const std::vector<Eigen::Vector3d> rays = sensor_.camera.ray_table();
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const float z = frame.depth[i];
    if (z == DepthFrame::kInvalid || z == DepthFrame::kOutOfRange || !rays[i].allFinite()) continue;
    const auto voxel =
        grid_.index_of(T_world_camera * Eigen::Vector3d(rays[i] * static_cast<double>(z)));
    if (voxel && grid_.belief(*voxel)) frame.depth[i] = DepthFrame::kInvalid;
  }
}

ModelProgress Model::update(const Measurements& measurements) {
  const Stopwatch watch;
  std::vector<DepthFrame> frames = measurements.frames;
  for (DepthFrame& frame : frames) {
    if (filter_) filter_->apply(frame);
    if (!config_.refine) drop_known_readings(frame, measurements.T_world_camera);
  }
  std::uint64_t inside = 0;
  const bool first = grid_.views().empty();
  for (const DepthFrame& frame : frames) {
    inside += integrator_.integrate(grid_, frame, measurements.T_world_camera).readings_inside;
  }
  if (first && inside == 0) {
    throw Error(ErrorCode::invalid_argument,
                "the first view has no reading in the workspace: the start pose looks away from it "
                "or is out of range");
  }
  seconds_["integrate"] += watch.seconds();
  derive();
  if (truth_) {
    const Stopwatch quality_watch;
    quality_.push_back(truth_->figures(surface_, points_));
    seconds_["quality"] += quality_watch.seconds();
  }
  const GridStatistics statistics = grid_.statistics(config_.criterion);
  ModelProgress progress{statistics.entropy_removed, statistics.unknown, std::nullopt};
  if (truth_) progress.coverage = quality_.back().coverage_visible;
  return progress;
}

void Model::derive() {
  {
    const Stopwatch watch;
    scene_ = VoxelScene::build(grid_, {}, exec_);
    seconds_["snapshot"] += watch.seconds();
  }
  const Stopwatch watch;
  points_ = fused_points(grid_, config_.points, exec_);
  surface_ = surface_of(points_, grid_.voxel_size());
  seconds_["surface"] += watch.seconds();
}

}  // namespace viewgain::app
