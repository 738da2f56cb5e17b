// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "gain/reading_worth.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard_probe.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Area of new surface that frames show, to compare with ViewGain::area. Immutable; thread safe.
/// Cost of of(): a pass over the pixels. Results do not depend on the number of threads.
class RealisedArea {
 public:
  /// Removes the lens distortion once. Readings of the support plane (world z [m]) do not count.
  RealisedArea(const Sensor& sensor, double voxel_size, std::optional<double> support_plane = {});

  /// Σ ω t² ρ(t) [m²] over the frame's readings of new surface within the sensor's range. Such a
  /// reading lies in an unknown voxel of `before` and does not show a known object
  /// (DepthFrame::known_depth). It is more than 1.2 pooling lengths from known surface, or its ray
  /// would reach known surface from behind (FromBehind). `hazard`: that of the same map; null if no
  /// surface is known. Throws Error(invalid_argument) like check_frame_size().
  [[nodiscard]] double of(const DepthFrame& frame, const Pose& T_world_camera,
                          const BeliefGrid& before, const HazardProbe* hazard,
                          ThreadPool& pool) const;

 private:
  /// Appends the areas of the readings of new surface among the pixels [begin, end).
  void add_areas(const DepthFrame& frame, const Pose& T_world_camera, const BeliefGrid& before,
                 const HazardProbe* hazard, const std::array<std::size_t, 2>& pixels,
                 std::vector<double>& areas) const;

  Sensor sensor_;
  std::optional<double> support_plane_;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rays_;
  std::vector<double> solid_angles_;  // [sr]
  ReadingWorth worth_;
};

}  // namespace viewgain::detail
