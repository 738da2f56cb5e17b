// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "apps/planner/bin_scene.hpp"
#include "viewgain/planner.h"

namespace viewgain::test {

inline std::vector<double> numbers_of(const std::vector<Pose>& poses) {
  std::vector<double> numbers;
  for (const Pose& pose : poses) {
    numbers.insert(numbers.end(), pose.m.begin(), pose.m.end());
    for (const double last : {0.0, 0.0, 0.0, 1.0}) numbers.push_back(last);
  }
  return numbers;
}

// The sensor and settings of BinScene for C.
struct CScene {
  BinScene scene;
  vg_sensor sensor;
  vg_planner_config config;
  std::vector<double> boxes;

  explicit CScene(GainModel model = GainModel::combined) {
    vg_sensor_init(&sensor, sizeof sensor);
    const PinholeCamera& c = scene.sensor.camera;
    sensor.width = c.width, sensor.height = c.height;
    sensor.fx = c.fx, sensor.fy = c.fy, sensor.cx = c.cx, sensor.cy = c.cy;
    sensor.min_range = scene.sensor.min_range;
    sensor.max_range = scene.sensor.max_range;
    sensor.working_distance = scene.sensor.working_distance;
    sensor.noise_model = VG_NOISE_CONSTANT;
    sensor.noise[0] = sensor.noise[1] = 0.001;
    const PlannerConfig own = scene.config(model);
    vg_planner_config_init(&config, sizeof config);
    config.num_threads = 1;
    config.gain = static_cast<int32_t>(model);
    config.voxel_size = own.grid.voxel_size;
    for (std::size_t a = 0; a < 3; ++a) {
      config.box_min[a] = own.grid.workspace.min[a];
      config.box_max[a] = own.grid.workspace.max[a];
    }
    config.support_plane = *own.surroundings.support_plane;
    config.jump_edge_angle = 0;
    for (const Box& box : own.surroundings.obstacles.boxes) {
      boxes.insert(boxes.end(), box.min.begin(), box.min.end());
      boxes.insert(boxes.end(), box.max.begin(), box.max.end());
    }
    config.boxes = boxes.data();
    config.box_count = 2;
    if (scene.sensor.T_flange_camera) {
      config.has_flange = 1;
      const std::vector<double> flange = numbers_of({*scene.sensor.T_flange_camera});
      std::copy(flange.begin(), flange.end(), config.T_flange_camera);
    }
  }
};

}  // namespace viewgain::test
