// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "gain/reading_worth.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain::detail {

/// What frames of a sensor show of new surface, to be held against ViewGain::area. Immutable;
/// thread safe. Cost of of(): a pass over the pixels.
class RealisedArea {
 public:
  /// Undoes the lens distortion once. Readings of the support plane (world z [m]) show nothing.
  RealisedArea(const Sensor& sensor, double voxel_size, std::optional<double> support_plane = {});

  /// Σ ω t² ρ(t) [m²] over the frame's readings of new surface within the sensor's range. They
  /// lie in unknown voxels of `before`, at d > 1.2 pooling lengths from what is known of the
  /// surface (`hazard`: that of the same map; null: nothing is known), and show nothing known
  /// (DepthFrame::known_depth); or their ray would come to known surface from behind (FromBehind).
  /// Throws Error(invalid_argument) as check_frame_size().
  [[nodiscard]] double of(const DepthFrame& frame, const Pose& T_world_camera,
                          const BeliefGrid& before, const HazardField* hazard) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  std::vector<Eigen::Vector3d> rays_;
  std::vector<double> solid_angles_;  // [sr]
  ReadingWorth worth_;
};

}  // namespace viewgain::detail
