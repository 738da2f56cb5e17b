// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>

#include "map/leaf_scales.hpp"
#include "vdb_layout.hpp"
#include "viewgain/support/solid_voxels.hpp"

namespace viewgain::detail {

/// The grid of a file with the scales of leaves, each in all of its leaf's voxels of the workspace;
/// there only if one is not 0. Beliefs stand at the lowest voxels of their cells.
inline constexpr const char* kScaleGridName = "scale";

/// The voxels of a block that belong to the workspace.
[[nodiscard]] inline openvdb::CoordBBox block_box(const GridStorage& s, Index3 origin) {
  const VoxelBox part = clipped(s.lattice, origin, kBlockSize);
  return {to_coord(part.min), to_coord(part.max).offsetBy(-1)};
}

/// Is each cell of the block of one code, with beliefs at lowest voxels alone?
[[nodiscard]] inline bool is_by_cells(const GridStorage& s, std::uint64_t key, int scale) {
  const Index3 origin = s.lattice.origin(key);
  bool result = true;
  if (const CodeLeaf* leaf = s.tree.probeConstLeaf(to_coord(origin))) {
    for_each_bit(s.lattice.clip(origin), [&](unsigned i) {
      result = result && leaf->getValue(i) == leaf->getValue(cell_offset(i, scale));
    });
  }
  if (const BeliefBlock* block = s.find_beliefs(key)) {
    for_each_bit(block->mask, [&](unsigned i) { result = result && cell_offset(i, scale) == i; });
  }
  return result;
}

/// Puts an occupied tile of a file that is, by the file's scales, one cell; false if it is more. It
/// counts as eight voxels, a leaf as 512.
[[nodiscard]] inline bool put_cell(const openvdb::FloatTree& scales, const openvdb::CoordBBox& box,
                                   std::uint8_t code, SolidVoxels& solid, GridStorage& s) {
  float scale = 0;
  if (box.dim().x() != kBlockSize || !scales.probeValue(box.min(), scale)) return false;
  if (scale != float{kMaxScale}) return false;
  solid.add({0, 0, 0}, {2, 2, 2});
  s.tree.addTile(kBlockTileLevel, box.min(), code, is_non_free(code));
  return true;
}

/// Takes the scales of a file over into a map that has its states and beliefs. Returns what is
/// wrong with them, empty if nothing is.
[[nodiscard]] inline std::string take_scales(const openvdb::FloatTree& tree, GridStorage& s) {
  for (const std::uint64_t key : held_blocks(s)) {
    const Index3 origin = s.lattice.origin(key);
    const openvdb::CoordBBox box = block_box(s, origin);
    float value = 0;
    bool is_one = true;  // of all the leaf's voxels
    const bool is_there = tree.probeValue(box.min(), value);
    if (const auto* leaf = tree.probeConstLeaf(to_coord(origin))) {
      for_each_bit(s.lattice.clip(origin), [&](unsigned i) {
        is_one = is_one && leaf->isValueOn(i) == is_there && leaf->getValue(i) == value;
      });
    }
    if (is_one && !is_there) continue;
    const int scale = value == 1 ? 1 : value == 2 ? 2 : value == 3 ? 3 : 0;
    if (!is_one || scale == 0 || fitting_scale(s.lattice, origin, scale) != scale ||
        !is_by_cells(s, key, scale)) {
      std::ostringstream fault;
      fault << "the leaf of voxel " << box.min()
            << " has no scale that its states and beliefs have";
      return fault.str();
    }
    s.put_scale(key, scale);
    s.fold_cell(key);
    if (const BeliefBlock* block = s.find_beliefs(key)) {
      const_cast<BeliefBlock*>(block)->scale = static_cast<std::uint8_t>(scale);  // nobody else's
    }
  }
  return {};
}

}  // namespace viewgain::detail
