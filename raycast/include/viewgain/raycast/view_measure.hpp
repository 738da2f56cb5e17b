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

/// A ray of a view that ends in a voxel.
struct VIEWGAIN_EXPORT ViewHit {
  Index3 voxel{};
  VoxelState state = VoxelState::unknown;  ///< unknown or occupied
  const Belief* belief = nullptr;     ///< what is known of the voxel; null: nothing; lives with the
                                      ///< scene
  std::size_t ray = 0;                ///< pixel index, row by row, strided; as in trace()
  double range = 0;                   ///< max(range of the entry point, min_range) [m]
  std::array<double, 3> direction{};  ///< of the ray, unit length, world frame
};

/// A gain of the user's own: a number for what a view would see. GainEvaluator::evaluate() traces
/// the views and hands over their hits. apps/examples/own_gain.cpp is one in thirty lines.
///
/// Thread safety: measure() is called from many threads at once.
class VIEWGAIN_EXPORT ViewMeasure {
 public:
  virtual ~ViewMeasure();

  /// `hits`: the rays that end in an unknown or occupied voxel, by tiles of 4x4 pixels, in the same
  /// order for any number of threads; valid during the call. Rays that meet nothing or an obstacle
  /// are not among them. What it throws ends the batch and reaches the caller.
  [[nodiscard]] virtual double measure(const Pose& T_world_camera,
                                       std::span<const ViewHit> hits) const = 0;
};

}  // namespace viewgain
