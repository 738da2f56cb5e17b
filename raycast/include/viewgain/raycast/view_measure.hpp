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

/// A custom gain: computes a number from the voxels that a view's rays hit.
/// GainEvaluator::evaluate() traces the rays and passes the hits (example:
/// apps/examples/own_gain.cpp).
///
/// Thread safety: measure() is called from many threads at once, and once or twice per pose.
class VIEWGAIN_EXPORT ViewMeasure {
 public:
  /// A ray of a view that ends in a voxel.
  struct Hit {
    Index3 voxel{};                          ///< voxel of the end
    VoxelState state = VoxelState::unknown;  ///< unknown or occupied
    /// What the voxel stores about its readings; null: none. Valid as long as the scene.
    const Belief* belief = nullptr;
    std::size_t ray = 0;                ///< pixel index, row-major, strided; as in trace()
    double range = 0;                   ///< max(range of the entry point, min_range) [m]
    std::array<double, 3> direction{};  ///< of the ray, unit length, world frame
  };

  virtual ~ViewMeasure();

  /// `hits`: the rays that end in an unknown or occupied voxel; valid during the call. Rays that
  /// hit nothing, or an obstacle, are omitted. Rays are ordered by tiles of 4x4 pixels, in the same
  /// order for any number of threads. Returns the view's gain in any unit. An exception ends the
  /// batch and reaches the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const Hit> hits) const = 0;
};

/// A custom gain that sees all unknown voxels that a view's rays pass, in order. As for the surface
/// gain, rays continue through unknown voxels to the first occupied one, an obstacle, the support
/// plane, the range limit or the workspace's edge.
///
/// Thread safety: measure() is called from many threads at once, and once or twice per pose.
class VIEWGAIN_EXPORT RunMeasure {
 public:
  /// The part of a ray inside one voxel.
  struct Run {
    Index3 voxel{};                          ///< voxel that contains the part
    VoxelState state = VoxelState::unknown;  ///< unknown, or occupied: the ray ends there
    /// What the voxel stores about its readings; null: none. Valid as long as the scene.
    const Belief* belief = nullptr;
    std::size_t ray = 0;                ///< pixel index, row-major, strided; as in trace()
    double begin = 0, end = 0;          ///< ranges along the ray [m]; occupied: both at the entry
    double rate = 0;                    ///< hazard [1/m]; occupied: 0
    std::array<double, 3> direction{};  ///< of the ray, unit length, world frame
  };

  virtual ~RunMeasure();

  /// `runs`: for each ray, the unknown voxels that it passes, nearest first, and then the occupied
  /// voxel in which it ends, if any; valid during the call. Rays are ordered by tiles of 4x4
  /// pixels, in the same order for any number of threads. Returns the view's gain in any unit. An
  /// exception ends the batch and reaches the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const Run> runs) const = 0;
};

}  // namespace viewgain
