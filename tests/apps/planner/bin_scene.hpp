// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/planner/planner_set_up.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/obstacle_view.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::test {

/// A block in a bin with two walls, on a table, and a camera with few pixels above it.
struct BinScene {
  Sensor sensor = sensor_preset("sr4000");
  Obstacles walls;
  Box block{{-0.06, -0.04, 0.0}, {0.05, 0.05, 0.06}};
  std::shared_ptr<const SurfaceScene> block_scene;
  SimulationConfig simulation;
  std::vector<Pose> views = dome_poses(40, 0.45, {0, 0, 0.05});

  BinScene() {
    PinholeCamera& c = sensor.camera;
    c.width = 64, c.height = 48, c.fx = 80, c.fy = 80, c.cx = 31.5, c.cy = 23.5;
    sensor.noise = ConstantNoise{0.001, 0.001};
    walls.boxes = {{{-0.13, -0.1, 0}, {-0.11, 0.1, 0.1}}, {{0.11, -0.1, 0}, {0.13, 0.1, 0.1}}};
    block_scene = std::make_shared<const SurfaceScene>(mesh_of(Obstacles{{block}, {}}));
    simulation.support_plane = 0.0;
    simulation.surroundings = std::make_shared<const SurfaceScene>(mesh_of(walls));
    // Those that the camera can see something from.
    std::erase_if(views, [](const Pose& pose) { return pose.translation().z() < 0.25; });
  }

  [[nodiscard]] DepthFrame see(const Pose& pose, std::uint64_t frame = 0) const {
    return SimulatedSensor(block_scene, sensor, simulation, {1}).acquire(pose, frame);
  }

  [[nodiscard]] PlannerSetUp config(GainModel model = GainModel::combined) const {
    PlannerSetUp config;
    config.map.voxel_size = 0.006;
    config.map.workspace = {{-0.15, -0.12, 0.0}, {0.15, 0.12, 0.12}};
    config.map.obstacles = walls;
    config.map.support_plane = 0.0;
    config.map.jump_edges.reset();
    config.map.gain.model = model;
    return config;
  }
};

/// The notes in a map's file, without sensor and frames.
inline std::map<std::string, std::string> notes_of(const std::filesystem::path& path) {
  return load_vdb(path).notes().others;
}

/// A planner's state as text, but for its last proposal; equal texts are
/// equal bits.
inline std::string seen_of(const ViewPlanner& planner) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "seen.vdb";
  planner.save(path);
  return planner.scorer().grid().content_hash() + notes_of(path).at("planner");
}

}  // namespace viewgain::test
