// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard_probe.hpp"

namespace viewgain {

/// Counts how often the rays of frames meet the surface in unknown space, to correct the hazard
/// (apps/docs/guide/surface_gain.md). The hazard is the rate at which a ray through unknown voxels
/// meets the surface [1/m].
///
/// Thread safety: one call at a time on one grid. Results do not depend on the number of threads.
class VIEWGAIN_EXPORT HazardCalibration {
 public:
  /// `support_plane` is the height z of a table in the world frame [m], which is not checked.
  /// Starts threads. Throws Error(invalid_argument) if the sensor is invalid, and whatever
  /// thread_count() throws.
  explicit HazardCalibration(const Sensor& sensor, std::optional<double> support_plane = {},
                             const ExecConfig& exec = {});
  ~HazardCalibration();
  HazardCalibration(HazardCalibration&&) noexcept;
  HazardCalibration& operator=(HazardCalibration&&) noexcept;

  /// Adds a frame to the grid's counters. Call it before the frame is integrated. `hazard` must be
  /// made from the current map. Follows about 800 rays through unknown voxels, up to 3 σ_ax in
  /// front of their reading (measured depth). The model predicts how often a ray meets the surface:
  /// its rate, summed along the ray's length in unknown voxels. A ray has met the surface if its
  /// reading lies in an unknown voxel. Rays that are out of range, or end on the support plane or a
  /// known object, have met no surface.
  ///
  /// Has no effect if no surface is known yet, HazardProbe::follows_counters() is false, or the
  /// frame sees almost no unknown space. Throws Error(invalid_argument) if the frame does not have
  /// the sensor's size, the pose is not rigid within 1e-3, or grid and hazard have different voxel
  /// sizes. Cost: about 5 ms on one thread.
  void count(BeliefGrid& grid, const HazardProbe& hazard, const DepthFrame& frame,
             const Pose& T_world_camera) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
