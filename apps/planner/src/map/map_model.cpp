// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/map_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/frame_identity.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

bool sees_plane(const Sensor& sensor, const Eigen::Vector3d& point, const Eigen::Vector3d& sight,
                double plane) {
  const double range = sight.norm(), rise = sight.z() / range;  // its size is cosθ on the plane
  return is_of_plane(point.z() - plane, rise, sensor.sigmas(range, std::abs(rise)));
}

MapModelConfig with_plane(MapModelConfig config) {
  auto& own = config.integration.support_plane;
  if (own && own != config.surroundings.support_plane) {
    refuse("integration.support_plane is " + short_text(*own) +
           " m, but surroundings.support_plane differs: set the plane only in surroundings");
  }
  own = config.surroundings.support_plane;
  return config;
}

// Voxels as large as all that is to be mapped, or as the camera sees, are in another unit.
BeliefGrid empty_grid(const GridConfig& config, const Sensor& sensor) {
  BeliefGrid grid(config, sensor);
  const auto& [min, max] = config.workspace;
  const double longest = std::max({max[0] - min[0], max[1] - min[1], max[2] - min[2]});
  if (config.voxel_size < longest && config.voxel_size <= sensor.max_range) return grid;
  refuse("voxels of " + short_text(config.voxel_size) + " m in a workspace of " +
         short_text(longest) + " m, for a sensor that sees to " + short_text(sensor.max_range) +
         " m: lengths are in metres");
}

}  // namespace

RealisedArea::RealisedArea(const Sensor& sensor, std::optional<double> support_plane)
    : sensor_(sensor),
      support_plane_(support_plane),
      rays_(sensor.camera.ray_table()),
      solid_angles_(sensor.camera.solid_angles(rays_)) {}

double RealisedArea::of(const DepthFrame& frame, const Pose& T_world_camera,
                        const BeliefGrid& before, const HazardField* hazard) const {
  check_frame_size(frame, sensor_.camera);
  double area = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const float z = frame.depth[i];
    if (!(z > 0) || !std::isfinite(z) || !rays_[i].allFinite()) continue;
    const Eigen::Vector3d p_camera = static_cast<double>(z) * rays_[i];
    const double range = p_camera.norm();
    if (range < sensor_.min_range || range > sensor_.max_range) continue;
    if (frame.shows_known(i)) continue;
    const Eigen::Vector3d point = T_world_camera * p_camera;
    if (support_plane_ &&
        sees_plane(sensor_, point, point - T_world_camera.translation(), *support_plane_)) {
      continue;
    }
    const std::optional<Index3> voxel = before.index_of(point);
    if (!voxel || before.state(*voxel) != VoxelState::unknown) continue;
    if (hazard != nullptr && !hazard->is_new(*voxel)) continue;
    area += solid_angles_[i] * range * range;
  }
  return area;
}

MapModel::MapModel(const Sensor& sensor, const MapModelConfig& config, const ExecConfig& exec)
    : MapModel(empty_grid(config.grid, sensor), sensor, config, exec) {}

MapModel::MapModel(BeliefGrid grid, const Sensor& sensor, const MapModelConfig& config,
                   const ExecConfig& exec)
    : sensor_(sensor),
      config_(with_plane(config)),
      exec_(exec),
      grid_(std::move(grid)),
      rays_(sensor.camera.ray_table()),
      obstacles_(config.surroundings.obstacles, sensor, exec),
      integrator_(sensor, config_.integration, exec),
      check_(sensor, config.surroundings.support_plane),
      new_surface_(sensor, config.surroundings.support_plane),
      calibration_(sensor, config.surroundings.support_plane),
      scene_(config.keep_scene ? VoxelScene::build(grid_, config.surroundings, exec, config.hazard)
                               : nullptr) {
  if (config.jump_edges) filter_.emplace(sensor.camera, *config.jump_edges);
}

FrameVerdict MapModel::judged(const Measurements& measurements) const {
  for (const double sigma :
       {measurements.pose_sigma.translation, measurements.pose_sigma.rotation}) {
    if (std::isfinite(sigma) && sigma >= 0) continue;
    refuse("the sigma " + short_text(sigma) + " of a pose is negative or not finite");
  }
  for (const DepthFrame& frame : measurements.frames) check_identity(frame.identity);
  if (!rigid_pose(measurements.T_world_camera)) return FrameVerdict::lost_pose;
  try {
    for (const DepthFrame& frame : measurements.frames) check_frame_size(frame, sensor_.camera);
  } catch (const Error&) {
    return FrameVerdict::wrong_size;
  }
  return FrameVerdict::used;
}

bool MapModel::shows_workspace(const DepthFrame& frame, const Pose& T_world_camera) const {
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const Eigen::Vector3d p = static_cast<double>(frame.depth[i]) * rays_[i];
    const double range = p.norm();
    // False for pixels without a depth and without a ray.
    if (!(range >= sensor_.min_range && range <= sensor_.max_range)) continue;
    if (!frame.shows_known(i) && grid_.index_of(T_world_camera * p)) return true;
  }
  return false;
}

void MapModel::drop_known_readings(DepthFrame& frame, const Pose& T_world_camera) const {
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const float z = frame.depth[i];
    if (z == DepthFrame::kInvalid || z == DepthFrame::kOutOfRange || !rays_[i].allFinite())
      continue;
    const auto voxel =
        grid_.index_of(T_world_camera * Eigen::Vector3d(rays_[i] * static_cast<double>(z)));
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

void MapModel::integrate(BeliefGrid& grid, const std::vector<DepthFrame>& frames,
                         const Measurements& measurements, MapUpdate& update) {
  const Pose& T_world_camera = measurements.T_world_camera;
  if (config_.follow_surface) {
    update.new_area = 0;
    if (!frames.empty()) {
      const DepthFrame& first = frames.front();
      std::optional<HazardField> own;
      if (!scene_) own.emplace(grid.snapshot(), config_.hazard);
      const HazardField& hazard = scene_ ? scene_->hazard() : *own;
      update.new_area = new_surface_.of(first, T_world_camera, grid, &hazard);
      calibration_.count(grid, hazard, first, T_world_camera);
    }
  }
  for (const DepthFrame& frame : frames) {
    if (&grid == &grid_) check_.look(grid, frame, T_world_camera, measurements.pose_sigma);
    update.counts += integrator_.integrate(grid, frame, T_world_camera, measurements.pose_sigma);
  }
}

MapUpdate MapModel::update(const Measurements& measurements) {
  MapUpdate update;
  update.verdict = judged(measurements);
  for (const DepthFrame& frame : measurements.frames) {
    check_.see(frame, measurements.T_world_camera);
  }
  if (update.verdict != FrameVerdict::used) return update;
  const Stopwatch watch;
  const std::vector<DepthFrame> frames = filtered(measurements, &update.flying_pixels);
  const bool has_readings = std::any_of(frames.begin(), frames.end(), [&](const DepthFrame& frame) {
    return shows_workspace(frame, measurements.T_world_camera);
  });
  if (has_readings) {
    integrate(grid_, frames, measurements, update);
    if (update.counts.readings_inside == 0) update.verdict = FrameVerdict::carved;
  } else {
    // What carves nothing either leaves no trace, which only carving can tell.
    BeliefGrid carved = grid_.clone();
    integrate(carved, frames, measurements, update);
    const IntegrationReport& counts = update.counts;
    if (counts.voxels_crossed + counts.voxels_hit > 0) {
      update.verdict = FrameVerdict::carved;
      for (const DepthFrame& frame : frames) {
        check_.look(grid_, frame, measurements.T_world_camera, measurements.pose_sigma);
      }
      grid_ = std::move(carved);
    } else {
      const bool says_something = counts.readings + counts.plane_readings + counts.out_of_range > 0;
      update.verdict = says_something ? FrameVerdict::outside : FrameVerdict::nothing_in_range;
    }
  }
  update.seconds["integrate"] = watch.seconds();
  if (!is_in_map(update.verdict)) return update;
  const Stopwatch scene_watch;
  if (scene_) scene_ = VoxelScene::update(scene_, grid_, exec_);
  update.seconds["snapshot"] = scene_watch.seconds();
  return update;
}

BeliefGrid MapModel::grid_after(const Measurements& measurements) const {
  const FrameVerdict verdict = judged(measurements);
  if (verdict != FrameVerdict::used) {
    refuse("the frames cannot be used: " + std::string(frame_verdict_name(verdict)));
  }
  BeliefGrid grid = grid_.clone();
  FrameIntegrator integrator(sensor_, config_.integration, exec_);
  for (const DepthFrame& frame : filtered(measurements, nullptr)) {
    integrator.integrate(grid, frame, measurements.T_world_camera, measurements.pose_sigma);
  }
  return grid;
}

ModelProgress MapModel::progress() const {
  const BeliefGrid::Statistics statistics = grid_.statistics(config_.criterion);
  ModelProgress progress;
  progress.entropy_removed = statistics.entropy_removed;
  progress.unknown_voxels = statistics.unknown;
  return progress;
}

}  // namespace viewgain
