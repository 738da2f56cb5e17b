// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/map_model.hpp"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

void add(IntegrationReport& sum, const IntegrationReport& frame) {
  sum.readings += frame.readings;
  sum.plane_readings += frame.plane_readings;
  sum.out_of_range += frame.out_of_range;
  sum.invalid += frame.invalid;
  sum.readings_inside += frame.readings_inside;
  sum.voxels_hit += frame.voxels_hit;
  sum.voxels_crossed += frame.voxels_crossed;
}

MapModelConfig with_plane(MapModelConfig config) {
  config.integration.support_plane = config.surroundings.support_plane;
  return config;
}

}  // namespace

MapModel::MapModel(const Sensor& sensor, const MapModelConfig& config, const ExecConfig& exec)
    : MapModel(BeliefGrid(config.grid, sensor), sensor, config, exec) {}

MapModel::MapModel(BeliefGrid grid, const Sensor& sensor, const MapModelConfig& config,
                   const ExecConfig& exec)
    : sensor_(sensor),
      config_(with_plane(config)),
      exec_(exec),
      grid_(std::move(grid)),
      obstacles_(config.surroundings.obstacles, sensor, exec),
      integrator_(sensor, config_.integration, exec),
      new_surface_(sensor, config.surroundings.support_plane),
      calibration_(sensor, config.surroundings.support_plane),
      scene_(config.keep_scene ? VoxelScene::build(grid_, config.surroundings, exec, config.hazard)
                               : nullptr) {
  if (config.jump_edges) filter_.emplace(sensor.camera, *config.jump_edges);
}

void MapModel::check(const Measurements& measurements) const {
  if (!rigid_pose(measurements.T_world_camera)) {
    throw Error(ErrorCode::invalid_argument,
                "the pose of the frames is not a rigid transform of finite numbers");
  }
  for (const double sigma :
       {measurements.pose_sigma.translation, measurements.pose_sigma.rotation}) {
    if (std::isfinite(sigma) && sigma >= 0) continue;
    throw Error(ErrorCode::invalid_argument,
                "the sigma " + short_text(sigma) + " of a pose is negative or not finite");
  }
  for (const DepthFrame& frame : measurements.frames) check_frame_size(frame, sensor_.camera);
}

void MapModel::drop_known_readings(DepthFrame& frame, const Pose& T_world_camera) const {
  const std::vector<Eigen::Vector3d> rays = sensor_.camera.ray_table();
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const float z = frame.depth[i];
    if (z == DepthFrame::kInvalid || z == DepthFrame::kOutOfRange || !rays[i].allFinite()) continue;
    const auto voxel =
        grid_.index_of(T_world_camera * Eigen::Vector3d(rays[i] * static_cast<double>(z)));
    if (voxel && grid_.belief(*voxel)) frame.depth[i] = DepthFrame::kInvalid;
  }
}

std::vector<DepthFrame> MapModel::filtered(const Measurements& measurements,
                                           std::size_t* flying_pixels) const {
  std::vector<DepthFrame> frames = measurements.frames;
  for (DepthFrame& frame : frames) {
    const std::size_t flying = filter_ ? filter_->apply(frame) : 0;
    if (flying_pixels != nullptr) *flying_pixels += flying;
    if (!config_.refine) drop_known_readings(frame, measurements.T_world_camera);
    obstacles_.mark(frame, measurements.T_world_camera);
  }
  return frames;
}

MapUpdate MapModel::update(const Measurements& measurements) {
  check(measurements);
  MapUpdate update;
  const Stopwatch watch;
  const Pose& T_world_camera = measurements.T_world_camera;
  const std::vector<DepthFrame> frames = filtered(measurements, &update.flying_pixels);
  if (config_.follow_surface) {
    update.new_area = 0;
    if (!frames.empty()) {
      const DepthFrame& first = frames.front();
      std::optional<HazardField> own;
      if (!scene_) own.emplace(grid_.snapshot(), config_.hazard);
      const HazardField& hazard = scene_ ? scene_->hazard() : *own;
      update.new_area = new_surface_.of(first, T_world_camera, grid_, &hazard);
      calibration_.count(grid_, hazard, first, T_world_camera);
    }
  }
  for (const DepthFrame& frame : frames) {
    add(update.counts,
        integrator_.integrate(grid_, frame, T_world_camera, measurements.pose_sigma));
  }
  update.seconds["integrate"] = watch.seconds();
  const Stopwatch scene_watch;
  if (scene_) scene_ = VoxelScene::update(scene_, grid_, exec_);
  update.seconds["snapshot"] = scene_watch.seconds();
  return update;
}

BeliefGrid MapModel::grid_after(const Measurements& measurements) const {
  check(measurements);
  BeliefGrid grid = grid_.clone();
  FrameIntegrator integrator(sensor_, config_.integration, exec_);
  for (const DepthFrame& frame : filtered(measurements, nullptr)) {
    integrator.integrate(grid, frame, measurements.T_world_camera, measurements.pose_sigma);
  }
  return grid;
}

ModelProgress MapModel::progress() const {
  const GridStatistics statistics = grid_.statistics(config_.criterion);
  ModelProgress progress;
  progress.entropy_removed = statistics.entropy_removed;
  progress.unknown_voxels = statistics.unknown;
  return progress;
}

}  // namespace viewgain
