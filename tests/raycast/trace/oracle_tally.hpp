// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "oracle/rays.hpp"

namespace viewgain::test {

/// How the endings of rays compare with the oracle's.
struct OracleTally {
  std::size_t rays = 0;
  std::size_t same = 0;
  std::size_t ties = 0;     ///< others that the oracle accepts, see oracle::is_tie()
  std::size_t hits = 0;     ///< rays that end in a voxel or at an obstacle
  std::size_t entries = 0;  ///< of these, those whose range is that of the voxel's entry
  std::string first_wrong;  ///< the first ray that is neither the same nor a tie

  /// Counts the rays of a view; returns how many differ. `tolerance` [voxel]: see
  /// oracle::is_tie().
  std::size_t add(const oracle::DenseMap& map, const Sensor& sensor, const Pose& T_world_camera,
                  const std::vector<RayHit>& expected, const std::vector<RayHit>& actual,
                  double tolerance = 1e-4);

  /// All rays end where the oracle's do, ties apart, of which there are at most this share, at the
  /// range of the voxel's entry; and at least `least_hits` rays hit something.
  [[nodiscard]] testing::AssertionResult agrees(std::size_t least_hits,
                                                double share_of_ties = 1e-4) const;
};

}  // namespace viewgain::test
