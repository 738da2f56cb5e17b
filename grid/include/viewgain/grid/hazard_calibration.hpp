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

/// Learns from a sensor's frames how much of unknown space is surface
/// (apps/docs/guide/surface_gain.md).
///
/// Thread safety: one call at a time on one grid.
class VIEWGAIN_EXPORT HazardCalibration {
 public:
  /// `support_plane` [m]: height z of a table, world; it is not checked. Throws
  /// Error(invalid_argument) if the sensor is not valid.
  explicit HazardCalibration(const Sensor& sensor, std::optional<double> support_plane = {});

  /// Adds a frame to the grid's counters, before it is integrated; `hazard` is the field of the map
  /// as it stands. About 800 of the frame's pixels are followed. Where they pass unknown voxels the
  /// model's rate times the length was to be expected; a reading in an unknown voxel is a meeting;
  /// the last 3 σ_ax before a reading are left out. Pixels out of range, readings of the support
  /// plane and those of the frame's known depth meet nothing, invalid ones say nothing. Nothing
  /// happens while no surface is known, where the field does not follow the counters
  /// (HazardField::follows_counters), and for a frame that passes next to no unknown space. Throws
  /// Error(invalid_argument) as check_frame_size(), if the pose is not rigid (rigid_pose()), or if
  /// the hazard's voxels are not the grid's. About 5 ms.
  void count(BeliefGrid& grid, const HazardField& hazard, const DepthFrame& frame,
             const Pose& T_world_camera) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  std::vector<Eigen::Vector3d> rays_;
};

}  // namespace viewgain
