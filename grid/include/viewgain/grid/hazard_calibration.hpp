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
#include "viewgain/grid/hazard.hpp"

namespace viewgain {

/// Learns from frames which share of unknown space is surface (apps/docs/guide/surface_gain.md).
///
/// Thread safety: one call at a time on one grid.
class VIEWGAIN_EXPORT HazardCalibration {
 public:
  /// `support_plane` [m]: height z of a table, world; unchecked. Throws Error(invalid_argument) if
  /// the sensor is invalid.
  explicit HazardCalibration(const Sensor& sensor, std::optional<double> support_plane = {});

  /// Adds a frame to the grid's counters before its integration; `hazard` is the field of the
  /// current map. Follows about 800 pixels through unknown voxels, without the last 3 σ_ax before a
  /// reading: expected meetings are the model's rate times the length; a reading in an unknown
  /// voxel is a meeting. Pixels out of range, and readings of the support plane or known depths,
  /// meet nothing.
  ///
  /// Has no effect while no surface is known, if the field does not follow the counters
  /// (HazardField::follows_counters), and for a frame that sees almost no unknown space. Throws
  /// Error(invalid_argument) as check_frame_size(), if the pose is not rigid (rigid_pose()), or if
  /// voxel sizes differ. Cost: about 5 ms.
  void count(BeliefGrid& grid, const HazardField& hazard, const DepthFrame& frame,
             const Pose& T_world_camera) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  std::vector<Eigen::Vector3d> rays_;
};

}  // namespace viewgain
