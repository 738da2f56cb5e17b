// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/generators.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain::test {

/// A block between two known walls on a table, and a camera with few pixels above it.
struct ScorerScene {
  Sensor sensor = sensor_preset("sr4000");
  Box block{{-0.06, -0.04, 0.0}, {0.05, 0.05, 0.06}};
  Obstacles walls{{{{-0.13, -0.1, 0}, {-0.11, 0.1, 0.1}}, {{0.11, -0.1, 0}, {0.13, 0.1, 0.1}}}, {}};
  std::vector<Pose> poses = dome_poses(40, 0.45, {0, 0, 0.05});
  std::shared_ptr<const SurfaceScene> surface =
      std::make_shared<const SurfaceScene>(mesh_of(Obstacles{{block}, {}}));
  SimulationConfig simulation;

  ScorerScene() {
    PinholeCamera& c = sensor.camera;
    c.width = 64, c.height = 48, c.fx = 80, c.fy = 80, c.cx = 31.5, c.cy = 23.5;
    simulation.support_plane = 0.0;
    simulation.surroundings = std::make_shared<const SurfaceScene>(mesh_of(walls));
    std::erase_if(poses, [](const Pose& pose) { return pose.translation().z() < 0.25; });
  }

  [[nodiscard]] DepthFrame see(const Pose& pose, std::uint64_t frame = 0) const {
    return SimulatedSensor(surface, sensor, simulation, {1}).acquire(pose, frame);
  }
  [[nodiscard]] ScorerConfig config(GainModel model = kDefaultGain) const {
    ScorerConfig config;
    config.voxel_size = 0.006;
    config.workspace = {{-0.15, -0.12, 0.0}, {0.15, 0.12, 0.12}};
    config.obstacles = walls;
    config.support_plane = 0.0;
    config.gain.model = model;
    return config;
  }
};

/// What a ViewScorer does, by the parts alone: everything is made anew for each call.
class ScorerParts {
 public:
  ScorerParts(const Sensor& sensor, const ScorerConfig& config)
      : sensor_(sensor), config_(config), grid_(config.grid(), sensor) {}

  void add(DepthFrame frame, const Pose& pose) {
    if (config_.jump_edges) JumpEdgeFilter(sensor_.camera, *config_.jump_edges).apply(frame);
    ObstacleView(config_.obstacles, sensor_).mark(frame, pose);
    if (config_.gain.model != GainModel::paper) {
      const HazardCalibration calibration(sensor_, config_.support_plane);
      calibration.count(grid_, HazardProbe(grid_.snapshot(), config_.hazard), frame, pose);
    }
    FrameIntegrator(sensor_, config_.integration(), {1}).integrate(grid_, frame, pose);
  }
  [[nodiscard]] GainEvaluator evaluator() const {
    return {VoxelScene::build(grid_, config_.surroundings(), {1}, config_.hazard),
            sensor_,
            config_.gain,
            {1}};
  }
  [[nodiscard]] BeliefGrid& grid() { return grid_; }

 private:
  Sensor sensor_;
  ScorerConfig config_;
  BeliefGrid grid_;
};

}  // namespace viewgain::test
