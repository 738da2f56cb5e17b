// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Grids from dense arrays of states, and back.

#include <algorithm>
#include <array>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/grid_blocks.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain {
namespace {

using namespace detail;

void check_size(const BeliefGrid& grid, std::size_t size) {
  if (size != grid.voxel_count()) {
    throw Error(ErrorCode::invalid_argument, "array of " + std::to_string(size) +
                                                 " states for a workspace of " +
                                                 std::to_string(grid.voxel_count()) + " voxels");
  }
}

/// Calls row(first voxel, position in the array, length) for the rows along z of what a cube has in
/// the workspace.
template <typename Row>
void for_each_row(const BlockLattice& lattice, Index3 origin, std::int32_t size, Row&& row) {
  const VoxelBox box = clipped(lattice, origin, size);
  const auto along_y = static_cast<std::size_t>(lattice.max.y - lattice.min.y);
  const auto along_z = static_cast<std::size_t>(lattice.max.z - lattice.min.z);
  for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
      const std::size_t at = (static_cast<std::size_t>(x - lattice.min.x) * along_y +
                              static_cast<std::size_t>(y - lattice.min.y)) *
                                 along_z +
                             static_cast<std::size_t>(box.min.z - lattice.min.z);
      row(Index3{x, y, box.min.z}, at, static_cast<std::size_t>(box.max.z - box.min.z));
    }
  }
}

}  // namespace

BeliefGrid BeliefGrid::from_states(const GridConfig& config, std::span<const std::uint8_t> states) {
  BeliefGrid grid(config);
  check_size(grid, states.size());
  const auto wrong =
      std::find_if(states.begin(), states.end(), [](std::uint8_t s) { return s > 2; });
  if (wrong != states.end()) {
    throw Error(ErrorCode::invalid_argument, "state " + std::to_string(*wrong) + " at position " +
                                                 std::to_string(wrong - states.begin()) +
                                                 "; valid are 0, 1, 2");
  }
  constexpr std::array<std::uint8_t, 3> kCodes{kUnknownCode, kLiteralFreeCode,
                                               kLiteralOccupiedCode};
  const BlockLattice lattice(grid.min_index(), grid.dims());
  const Index3 first = block_origin(lattice.min);
  for (std::int32_t x = first.x; x < lattice.max.x; x += kBlockSize) {
    for (std::int32_t y = first.y; y < lattice.max.y; y += kBlockSize) {
      for (std::int32_t z = first.z; z < lattice.max.z; z += kBlockSize) {
        std::array<std::uint8_t, kBlockVoxels> codes{};
        bool any = false;
        for_each_row(lattice, {x, y, z}, kBlockSize,
                     [&](Index3 voxel, std::size_t at, std::size_t length) {
                       std::uint8_t* row = codes.data() + block_offset(voxel);
                       for (std::size_t k = 0; k < length; ++k) {
                         any = any || states[at + k] != 0;
                         row[k] = kCodes[states[at + k]];
                       }
                     });
        if (any) put_block(grid, {x, y, z}, codes.data());
      }
    }
  }
  return grid;
}

void BeliefGrid::copy_states(std::span<std::uint8_t> states) const {
  check_size(*this, states.size());
  const BlockLattice lattice(min_index(), dims());
  const auto state_of = [](std::uint8_t code) {
    return static_cast<std::uint8_t>(code_state(code));
  };
  visit_grid(
      *this,
      [&](Index3 origin, const std::uint8_t* codes) {
        for_each_row(lattice, origin, kBlockSize,
                     [&](Index3 voxel, std::size_t at, std::size_t length) {
                       const std::uint8_t* row = codes + block_offset(voxel);
                       std::transform(row, row + length,
                                      states.begin() + static_cast<std::ptrdiff_t>(at), state_of);
                     });
      },
      [&](Index3 origin, std::int32_t size, std::uint8_t code) {
        for_each_row(lattice, origin, size, [&](Index3, std::size_t at, std::size_t length) {
          std::fill_n(states.begin() + static_cast<std::ptrdiff_t>(at), length, state_of(code));
        });
      });
}

}  // namespace viewgain
