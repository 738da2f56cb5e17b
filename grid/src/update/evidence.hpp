// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {

/// What a frame can say about the voxel centres of a cube.
enum class CubeClass : std::uint8_t {
  untouched,  ///< no centre is crossed
  crossed,    ///< every centre is crossed at full weight
  cut,    ///< those that the image shows are crossed at full weight; its edge cuts the others off
  mixed,  ///< each must be looked at
};

/// What a frame says about the voxels in front of its readings. ConeEvidence and LineEvidence are
/// the two ways of carving. They offer:
/// - regions(): the regions in which a voxel may be crossed, in rising order;
/// - classify(): of the cube [origin, origin + size) as a whole;
/// - deltas(): of the 512 voxels of the block with this key, origin and scale, in steps of the
///   log-odds, kNoDelta where nothing is said, the same in all of a cell; false if nothing is said
///   anywhere.
template <typename T>
concept Evidence = requires(const T& evidence, const BlockLattice& lattice, std::uint64_t key,
                            Index3 origin, int size, int scale, std::int8_t* deltas) {
  { evidence.regions(lattice) } -> std::same_as<std::vector<std::uint64_t>>;
  { evidence.classify(origin, size) } -> std::same_as<CubeClass>;
  { evidence.deltas(key, origin, scale, deltas) } -> std::same_as<bool>;
};

}  // namespace viewgain::detail
