// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {

/// Effect of a frame on the voxel centres of a cube.
enum class CubeClass : std::uint8_t {
  untouched,  ///< no centre is crossed
  crossed,    ///< every centre is crossed at full weight
  cut,        ///< those in the image are crossed at full weight; the image edge excludes the others
  mixed,      ///< each must be checked
};

/// Effect of a frame on the voxels in front of its readings. ConeEvidence and LineEvidence
/// implement the two ways of marking free space. They offer:
/// - regions(): the regions in which a voxel can be crossed, in increasing order;
/// - classify(): the cube [origin, origin + size) as a whole;
/// - deltas(): the 512 voxels of the block with this key, origin and scale, in steps of the
/// log-odds or kNoDelta, the same in all voxels of a cell; false if there are none.
template <typename T>
concept Evidence = requires(const T& evidence, const BlockLattice& lattice, std::uint64_t key,
                            Index3 origin, int size, int scale, std::int8_t* deltas) {
  { evidence.regions(lattice) } -> std::same_as<std::vector<std::uint64_t>>;
  { evidence.classify(origin, size) } -> std::same_as<CubeClass>;
  { evidence.deltas(key, origin, scale, deltas) } -> std::same_as<bool>;
};

}  // namespace viewgain::detail
