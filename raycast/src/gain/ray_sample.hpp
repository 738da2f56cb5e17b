// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "trace/ray_tile.hpp"

namespace viewgain::detail {

/// How many voxels of a view a voxel stands for in which `hits` rays of a lattice end, and for how
/// many rays each of these hits does. `expected` is how many of the lattice's rays would end in it
/// if nothing stood before it: its exposed area over that of a lattice cell.
///
/// A voxel that is narrower than a cell is met by chance, one in `expected` times, and then by one
/// ray. A wider one is met for sure and stands for itself. But one in some voxels is partly hidden,
/// and is met less often than it should be: a single ray in a voxel that would take several tells
/// that others like it were missed.
struct SampledVoxel {
  double copies = 1;
  double rays_per_hit;

  SampledVoxel(double hits, double expected, double rays_each) : rays_per_hit(rays_each) {
    // All of the view's rays meet no more voxels than there are rays.
    expected = std::max(expected, 1 / rays_each);
    if (hits < 1.5) {
      copies = expected <= 1 ? 1 / expected : 1 + (kLoneHit - 1) * std::min(expected - 1, 1.0);
      rays_per_hit = std::max(1.0, rays_each * std::min(expected, 1.0));
    } else if (hits < 2.5) {
      copies = kTwoHits;
    }
  }

 private:
  // Fitted on maps of a room, see perf/results/choosing.md.
  static constexpr double kLoneHit = 1.6, kTwoHits = 1.15;
};

/// What a sample's rays gain.
struct SampleTally {
  /// By their place in the tile: sixteen lattices of every fourth ray and row.
  std::array<double, kTileRays> by_lane{};
  double gain = 0;
  double by_chance = 0;  ///< of the gain: voxels of under two cells, in which one ray ends
  double lone = 0;       ///< of the gain: larger ones in which one ray ends

  void add(double gained, double hits, double expected) {
    gain += gained;
    if (hits < 1.5) (expected < 2 ? by_chance : lone) += gained;
  }
};

}  // namespace viewgain::detail
