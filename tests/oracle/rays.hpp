// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "oracle/walk.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::oracle {

/// The rays of a view in pixel order, row by row: every stride-th pixel of every stride-th row.
[[nodiscard]] std::vector<Ray> view_rays(const Pose& T_world_grid, double voxel_size,
                                         const PinholeCamera& camera, int stride,
                                         const Pose& T_world_camera);

/// Range limits in voxels, the config's before the sensor's; no obstacle.
[[nodiscard]] RayLimits limits_of(const DenseMap& map, const Sensor& sensor,
                                  const GainConfig& config);

/// Where the nearest obstacle crosses the ray [voxel]; infinity: nowhere. Rays that start inside an
/// obstacle box are cut off at its far side.
[[nodiscard]] double obstacle_range(const DenseMap& map, const Obstacles& obstacles,
                                    const Ray& ray);

/// Where all rays of a view end.
[[nodiscard]] std::vector<RayHit> trace(const DenseMap& map, const Sensor& sensor,
                                        const GainConfig& config, const Pose& T_world_camera,
                                        const Obstacles& obstacles = {});

/// Of a reading along a direction of unit length.
[[nodiscard]] Eigen::Matrix3d information_of(const Sensor& sensor, const Eigen::Vector3d& d,
                                             double range);

/// Of the last region that holds the voxel's centre, else 1.
[[nodiscard]] double weight_of(const GainConfig& config, double voxel_size, Index3 v);

}  // namespace viewgain::oracle
