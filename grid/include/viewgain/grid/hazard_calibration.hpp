// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard_probe.hpp"

namespace viewgain {

/// Learns from frames how often rays through unknown space meet the surface
/// (apps/docs/guide/surface_gain.md).
///
/// Thread safety: one call at a time on one grid.
class VIEWGAIN_EXPORT HazardCalibration {
 public:
  /// `support_plane` [m]: height z of a table, world; unchecked. Throws Error(invalid_argument) if
  /// the sensor is invalid.
  explicit HazardCalibration(const Sensor& sensor, std::optional<double> support_plane = {});

  /// Adds a frame to the grid's counters. Call it before the frame is integrated; `hazard` must be
  /// the field of the current map. Follows about 800 rays through unknown voxels, up to 3 σ_ax
  /// nearer than the reading (the measured depth). The number of meetings that the model predicts
  /// is its rate times the length of the ray in unknown voxels. A ray has met the surface if its
  /// reading lies in an unknown voxel. Rays that are out of range, or end on the support plane or a
  /// known object, have met no surface.
  ///
  /// Has no effect while no surface is known, if HazardProbe::follows_counters() is false, and for
  /// a frame that sees almost no unknown space. Throws Error(invalid_argument) for a frame of
  /// another size, a pose that is not rigid (rigid_pose()), or if grid and hazard have different
  /// voxel sizes. Cost: about 5 ms.
  void count(BeliefGrid& grid, const HazardProbe& hazard, const DepthFrame& frame,
             const Pose& T_world_camera) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  std::vector<Eigen::Vector3d> rays_;
};

}  // namespace viewgain
