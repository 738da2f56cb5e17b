// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain {

/// A custom gain, computed from the voxels in which a view's rays end. GainEvaluator::evaluate()
/// traces the rays and calls measure() (example: apps/examples/own_gain.cpp).
///
/// Thread safety: measure() is called from many threads at once, once or twice per pose.
class VIEWGAIN_EXPORT ViewMeasure {
 public:
  /// The end of a ray in a voxel.
  struct Hit {
    Index3 voxel{};                          ///< voxel in which the ray ends
    VoxelState state = VoxelState::unknown;  ///< unknown or occupied
    /// Belief of the voxel; null: none. Valid as long as the scene.
    const Belief* belief = nullptr;
    std::size_t ray = 0;  ///< index of the ray, as in GainEvaluator::trace()
    double range = 0;     ///< range at which it enters the voxel, at least min_range [m]
    std::array<double, 3> direction{};  ///< direction of the ray, unit length, world frame
  };

  virtual ~ViewMeasure();

  /// Returns the gain of a view, in any unit. `hits` has an entry for each ray that ends in an
  /// unknown or occupied voxel, and is valid during the call. Rays are ordered by tiles of 4x4
  /// pixels, in the same order for any number of threads. An exception ends the batch and is
  /// rethrown to the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const Hit> hits) const = 0;
};

/// A custom gain, computed from all unknown voxels that a view's rays pass. As for the surface
/// gain, a ray continues through unknown voxels to the first occupied voxel, an obstacle, the
/// support plane, the range limit or the edge of the workspace.
///
/// Thread safety: measure() is called from many threads at once, once or twice per pose.
class VIEWGAIN_EXPORT RunMeasure {
 public:
  /// A run: the part of a ray inside one voxel.
  struct Run {
    Index3 voxel{};                          ///< voxel that contains the run
    VoxelState state = VoxelState::unknown;  ///< unknown, or occupied: the ray ends there
    /// Belief of the voxel; null: none. Valid as long as the scene.
    const Belief* belief = nullptr;
    std::size_t ray = 0;        ///< index of the ray, as in GainEvaluator::trace()
    double begin = 0, end = 0;  ///< ranges along the ray [m]; if occupied, both are at the entry
    double rate = 0;            ///< hazard [1/m], see HazardField; 0 if occupied
    std::array<double, 3> direction{};  ///< direction of the ray, unit length, world frame
  };

  virtual ~RunMeasure();

  /// Returns the gain of a view, in any unit. `runs` has, for each ray, the unknown voxels that it
  /// passes, nearest first, and then the occupied voxel in which it ends, if any. It is valid
  /// during the call. Rays are ordered by tiles of 4x4 pixels, in the same order for any number of
  /// threads. An exception ends the batch and is rethrown to the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const Run> runs) const = 0;
};

}  // namespace viewgain
