// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Grids from dense arrays of states, and back.

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "belief_blocks.hpp"
#include "grid_storage.hpp"
#include "leaf_scales.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/voxels_text.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr std::array<std::uint8_t, 3> kCodes{kUnknownCode, kLiteralFreeCode, kLiteralOccupiedCode};

void check_states(std::span<const std::uint8_t> states) {
  const auto wrong =
      std::find_if(states.begin(), states.end(), [](std::uint8_t s) { return s > 2; });
  if (wrong != states.end()) {
    refuse("the state at position " + std::to_string(wrong - states.begin()) + " is " +
           std::to_string(*wrong) + "; valid values: 0, 1, 2");
  }
}

void check_size(const BeliefGrid& grid, std::size_t size) {
  if (size != grid.voxel_count()) {
    refuse("the array has " + std::to_string(size) + " states, but the workspace has " +
           std::to_string(grid.voxel_count()) + " voxels");
  }
}

/// Calls row(first voxel, index in the array of `whole`, length) for the rows along z of a box
/// within it.
template <typename Row>
void for_each_row(const VoxelBox& whole, const VoxelBox& box, Row&& row) {
  const auto along_y = static_cast<std::size_t>(whole.max.y - whole.min.y);
  const auto along_z = static_cast<std::size_t>(whole.max.z - whole.min.z);
  for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
    for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
      const std::size_t at = (static_cast<std::size_t>(x - whole.min.x) * along_y +
                              static_cast<std::size_t>(y - whole.min.y)) *
                                 along_z +
                             static_cast<std::size_t>(box.min.z - whole.min.z);
      row(Index3{x, y, box.min.z}, at, static_cast<std::size_t>(box.max.z - box.min.z));
    }
  }
}
/// As above for the part of a cube in the workspace.
template <typename Row>
void for_each_row(const BlockLattice& lattice, Index3 origin, std::int32_t size, Row&& row) {
  for_each_row(lattice, clipped(lattice, origin, size), std::forward<Row>(row));
}

}  // namespace

BeliefGrid BeliefGrid::from_states(const GridConfig& config, std::span<const std::uint8_t> states,
                                   const Sensor& sensor) {
  BeliefGrid grid(config, sensor);
  check_size(grid, states.size());
  check_states(states);
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
        if (any) grid.storage_->put_block({x, y, z}, codes.data());
      }
    }
  }
  return grid;
}

std::uint64_t BeliefGrid::update_box(const VoxelBox& box, std::span<const std::uint8_t> states) {
  GridStorage& s = *storage_;
  if (box.intersection(s.lattice) != box) {
    refuse("the box (voxels " + voxels_text(box) + ") is not inside the workspace (voxels " +
           voxels_text(s.lattice) + ")");
  }
  if (states.size() != box.volume()) {
    refuse("the array has " + std::to_string(states.size()) + " states, but the box has " +
           std::to_string(box.volume()) + " voxels");
  }
  check_states(states);
  std::uint64_t changed = 0;
  const Index3 first = block_origin(box.min);
  for (std::int32_t x = first.x; x < box.max.x; x += kBlockSize) {
    for (std::int32_t y = first.y; y < box.max.y; y += kBlockSize) {
      for (std::int32_t z = first.z; z < box.max.z; z += kBlockSize) {
        const Index3 origin{x, y, z};
        std::array<std::uint8_t, kBlockVoxels> codes;
        if (const CodeLeaf* leaf = s.tree.probeConstLeaf(to_coord(origin))) {
          std::copy_n(leaf->buffer().data(), kBlockVoxels, codes.data());
        } else {
          codes.fill(s.tree.getValue(to_coord(origin)));
        }
        LeafMask other{};  // different states
        const VoxelBox part =
            box.intersection(VoxelBox::from_dims(origin, {kBlockSize, kBlockSize, kBlockSize}));
        for_each_row(box, part, [&](Index3 voxel, std::size_t at, std::size_t length) {
          for (std::size_t k = 0; k < length; ++k) {
            const unsigned offset = block_offset(voxel) + static_cast<unsigned>(k);
            if (static_cast<std::uint8_t>(code_state(codes[offset])) == states[at + k]) continue;
            codes[offset] = kCodes[states[at + k]];
            other[offset >> 6U] |= std::uint64_t{1} << (offset & 63U);
            ++changed;
          }
        });
        if (other == LeafMask{}) continue;
        const std::uint64_t key = s.lattice.key(origin);
        if (s.scale(key) != 0) {  // again, per voxel
          set_scale(s, key, 0);
          changed -= count_bits(other);
          z -= kBlockSize;
          continue;
        }
        s.mark_changed(key);
        s.put_block(origin, codes.data());
        const auto beliefs = s.beliefs.find(key);
        if (beliefs == s.beliefs.end()) continue;
        LeafMask left = beliefs->second->mask;
        for (std::size_t i = 0; i < left.size(); ++i) left[i] &= ~other[i];
        if (left == LeafMask{}) {
          s.beliefs.erase(beliefs);
        } else if (left != beliefs->second->mask) {
          beliefs->second = reshaped(beliefs->second.get(), left);
        }
      }
    }
  }
  if (changed > 0) ++s.time;
  return changed;
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
