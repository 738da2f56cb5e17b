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

/// A gain of the user's own: a number for what a view would see. GainEvaluator::evaluate() traces
/// the views and hands over their hits. apps/examples/own_gain.cpp is one in thirty lines.
///
/// Thread safety: measure() is called from many threads at once. Costs what measure() takes, once a
/// pose or, in two stages, twice.
class VIEWGAIN_EXPORT ViewMeasure {
 public:
  /// A ray of a view that ends in a voxel.
  struct Hit {
    Index3 voxel{};                          ///< that the ray ends in
    VoxelState state = VoxelState::unknown;  ///< unknown or occupied
    const Belief* belief = nullptr;  ///< what is known of the voxel; null: nothing; lives with the
                                     ///< scene
    std::size_t ray = 0;             ///< pixel index, row by row, strided; as in trace()
    double range = 0;                ///< max(range of the entry point, min_range) [m]
    std::array<double, 3> direction{};  ///< of the ray, unit length, world frame
  };

  virtual ~ViewMeasure();

  /// `hits`: the rays that end in an unknown or occupied voxel, by tiles of 4x4 pixels, in the same
  /// order for any number of threads; valid during the call. Rays that meet nothing or an obstacle
  /// are not among them. What it returns, in whatever unit, is the view's gain. What it throws ends
  /// the batch and reaches the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const Hit> hits) const = 0;
};

/// A gain of the user's own that looks at all that a view's rays might pass, in order: they go on
/// through unknown voxels as for the surface gain, to the first occupied one, an obstacle, the
/// support plane, the range limit or the workspace's edge.
///
/// Thread safety: measure() is called from many threads at once. Costs what measure() takes, once a
/// pose or, in two stages, twice.
class VIEWGAIN_EXPORT RunMeasure {
 public:
  /// What a ray of a view has of one voxel on its way through unknown space.
  struct Run {
    Index3 voxel{};                          ///< that the ray has a part of
    VoxelState state = VoxelState::unknown;  ///< unknown, or occupied: the ray ends there
    const Belief* belief = nullptr;  ///< what is known of the voxel; null: nothing; lives with the
                                     ///< scene
    std::size_t ray = 0;             ///< pixel index, row by row, strided; as in trace()
    double begin = 0, end = 0;       ///< ranges along the ray [m]; occupied: both where it enters
    double rate = 0;                 ///< hazard [1/m]; occupied: 0
    std::array<double, 3> direction{};  ///< of the ray, unit length, world frame
  };

  virtual ~RunMeasure();

  /// `runs`: of the rays by tiles of 4x4 pixels, each ray's in one piece and in order of range; its
  /// unknown voxels and the occupied one that ends it, if any. In the same order for any number of
  /// threads; valid during the call. What it returns, in whatever unit, is the view's gain. What it
  /// throws ends the batch and reaches the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const Run> runs) const = 0;
};

}  // namespace viewgain
