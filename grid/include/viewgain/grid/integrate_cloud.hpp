// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {

/// Puts point clouds into a belief grid: the sibling of FrameIntegrator for points that are no
/// pixels of a camera.
///
/// Each point is a reading along the line from the sensor's origin, which carves the voxels that it
/// passes through (IntegrationConfig::Carve::lines) and hits the one that holds the point, with the
/// sensor's covariance at that range and direction and frontal incidence. All points of a call
/// count as one frame: a voxel is updated once, a hit beats crossings. Ranges are treated as
/// FrameIntegrator does: nearer than min_range is invalid, farther than max_range carves as far as
/// that. A point that is not finite, or is the origin itself, is invalid. Of the sensor only noise,
/// fx (of the models whose sigma_lat is a pixel's footprint) and range limits matter. The map is
/// the same bit for bit for any number of threads, and for the points in any order but for the
/// rounding of the beliefs' sums.
///
/// Thread safety: one call at a time on one integrator and on one grid. Cost: grows with
/// the voxels crossed.
class VIEWGAIN_EXPORT CloudIntegrator {
 public:
  /// `config.carve` does not matter: clouds have no pixels to carve by. Throws
  /// Error(invalid_argument) if the sensor is not valid or the support plane is not finite.
  explicit CloudIntegrator(const Sensor& sensor, const IntegrationConfig& config = {},
                           const ExecConfig& exec = {});
  ~CloudIntegrator();
  CloudIntegrator(CloudIntegrator&&) noexcept;
  CloudIntegrator& operator=(CloudIntegrator&&) noexcept;

  /// Points in the world [m]; the origin is the pose's translation, its rotation matters only in
  /// the grid's views, to which the pose is appended. Throws Error(invalid_argument) if the pose is
  /// not rigid (1e-3; smaller errors are orthonormalised) and Error(capacity) for 2^32 points or
  /// more; the grid is unchanged then.
  IntegrationReport integrate(BeliefGrid& grid, std::span<const std::array<double, 3>> points,
                              const Pose& T_world_sensor);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The box, in the frame of T_world_grid, that holds every reading of the cloud [m], those of the
/// support plane left out; nothing if it has none. `points` [m] are in the world, in any order;
/// support_plane [m] as in IntegrationConfig. For choosing a workspace. Throws
/// Error(invalid_argument) as CloudIntegrator. Costs O(points).
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Box> reading_bounds(
    const Sensor& sensor, std::span<const std::array<double, 3>> points, const Pose& T_world_sensor,
    const Pose& T_world_grid = {}, std::optional<double> support_plane = {});

}  // namespace viewgain
