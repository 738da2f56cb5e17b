// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <span>
#include <vector>

#include "convert.hpp"
#include "viewgain/formats.h"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/formats/sensor_toml.hpp"

using namespace viewgain;
using namespace viewgain::c_api;

vg_status vg_sensor_load(const char* preset_or_file, vg_sensor* sensor) {
  return guarded("preset_or_file", {preset_or_file}, [&] {
    require_struct(sensor, "vg_sensor");
    write_sensor(load_sensor(preset_or_file), sensor);
  });
}

vg_status vg_sensor_save(const vg_sensor* sensor, const char* path) {
  return guarded("path", {path}, [&] { write_sensor_toml(path, sensor_of(sensor)); });
}

vg_status vg_range_calibration_load(const char* preset_or_file,
                                    vg_range_calibration** calibration) {
  return make_handle(calibration, "calibration preset_or_file", {preset_or_file}, [&] {
    const Sensor sensor = load_sensor(preset_or_file);
    return RangeCorrector(sensor.camera, sensor.range_calibration);
  });
}

vg_status vg_poses_load(const char* path, double* T_world_camera, double* timestamps,
                        size_t capacity, size_t* found) {
  return guarded("path found", {path, found}, [&] {
    const PoseList list = load_poses(path);
    const std::size_t count = std::min(capacity, list.poses.size());
    if (T_world_camera != nullptr) write_poses(std::span(list.poses).first(count), T_world_camera);
    if (timestamps != nullptr) std::copy_n(list.timestamps.begin(), count, timestamps);
    *found = list.poses.size();
  });
}

vg_status vg_poses_save(const char* path, const double* T_world_camera, const double* timestamps,
                        size_t count) {
  return guarded("path", {path}, [&] {
    if (count == 0) refuse("count is 0: a file of poses has at least one");
    const std::vector<Pose> poses = poses_of(T_world_camera, count);
    if (timestamps == nullptr) {
      save_poses(path, poses);
    } else {
      save_poses(path, poses, {timestamps, count});
    }
  });
}

vg_status vg_grid_load_octomap(const char* path, double prior_sigma, vg_grid** grid) {
  return make_handle(grid, "grid path", {path}, [&] {
    OctomapConfig config;
    config.prior_sigma = given(prior_sigma);
    return load_octomap(path, config);
  });
}

vg_status vg_grid_save_octomap(const vg_grid* grid, const char* path) {
  return guarded("grid path", {grid, path}, [&] { save_octomap(grid->grid, path); });
}
