// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "model.hpp"

#include <cmath>
#include <utility>

#include "mesh_area.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {

SurfaceMesh surface_of(const std::vector<FusedPoint>& points, double spacing,
                       const ExecConfig& exec) {
  std::vector<OrientedPoint> oriented;
  oriented.reserve(points.size());
  for (const FusedPoint& point : points) oriented.push_back({point.position, point.toward_free});
  SurfaceConfig config;
  config.spacing = spacing;
  return reconstruct_surface(oriented, config, exec);
}

Model::Model(const Sensor& sensor, const ModelConfig& config, std::shared_ptr<const Truth> truth,
             const LoopExec& exec)
    : sensor_(sensor),
      config_(config),
      exec_(exec),
      truth_(std::move(truth)),
      grid_(config.grid),
      integrator_(sensor, config.integration, exec.threads),
      new_surface_(sensor, config.integration.support_plane),
      calibration_(sensor, config.integration.support_plane) {
  if (config.jump_edges) filter_.emplace(sensor.camera, *config.jump_edges);
}

Model::Model(BeliefGrid grid, const Sensor& sensor, const ModelConfig& config, const LoopExec& exec)
    : sensor_(sensor),
      config_(config),
      exec_(exec),
      grid_(std::move(grid)),
      integrator_(sensor, config.integration, exec.threads),
      new_surface_(sensor, config.integration.support_plane),
      calibration_(sensor, config.integration.support_plane) {
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
  integrate(measurements);
  derive();
  if (truth_) {
    const auto measuring = exec_.measure("quality");
    quality_.push_back(truth_->figures(surface_, points_));
  }
  const GridStatistics statistics = grid_.statistics(config_.criterion);
  ModelProgress progress{statistics.entropy_removed, statistics.unknown};
  progress.surface_area = mesh_area(surface_);
  if (truth_) progress.coverage = quality_.back().coverage_visible;
  return progress;
}

std::vector<DepthFrame> Model::filtered(const Measurements& measurements) const {
  std::vector<DepthFrame> frames = measurements.frames;
  for (DepthFrame& frame : frames) {
    if (filter_) filter_->apply(frame);
    if (!config_.refine) drop_known_readings(frame, measurements.T_world_camera);
  }
  return frames;
}

std::vector<FusedPoint> Model::points_after(const Measurements& measurements) const {
  BeliefGrid grid = grid_.clone();
  FrameIntegrator integrator(sensor_, config_.integration, exec_.threads);
  for (const DepthFrame& frame : filtered(measurements)) {
    integrator.integrate(grid, frame, measurements.T_world_camera);
  }
  return fused_points(grid, config_.points, exec_.threads);
}

void Model::integrate(const Measurements& measurements) {
  const auto measuring = exec_.measure("integrate");
  const std::vector<DepthFrame> frames = filtered(measurements);
  realised_area_ =
      frames.empty() ? 0.0 : area_shown_by(frames.front(), measurements.T_world_camera);
  if (scene_ && !frames.empty()) {
    calibration_.count(grid_, scene_->hazard(), frames.front(), measurements.T_world_camera);
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
}

double Model::area_shown_by(const DepthFrame& frame, const Pose& T_world_camera) const {
  const HazardField* hazard = scene_ ? &scene_->hazard() : nullptr;
  return new_surface_.of(frame, T_world_camera, grid_, hazard);
}

void Model::derive() {
  {
    const auto measuring = exec_.measure("snapshot");
    scene_ = VoxelScene::build(grid_, config_.obstacles, exec_.threads, config_.hazard);
  }
  const auto measuring = exec_.measure("surface");
  points_ = fused_points(grid_, config_.points, exec_.threads);
  surface_ = surface_of(points_, pooling_of(scene_->snapshot()).length, exec_.threads);
}

}  // namespace viewgain::app
