// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>

#include "map/leaf_scales.hpp"
#include "map/map_notes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/solid_voxels.hpp"

// OpenVDB keeps state in its templates; with hidden visibility each library would have a copy
// (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "map/grid_layout.hpp"
#include "map/grid_storage.hpp"

// Definitions shared by the writer and the reader of map files.
namespace viewgain::detail {

// Version of the layout; other versions are refused. `state` and `hits` are floats, because
// OpenVDB's Python module only supports Float, Bool and Vec3S. A float holds whole numbers up to
// 2^24; if a voxel has more hits, `hits` is rounded, and the additional grid `hits_rest` holds the
// difference.
inline constexpr std::int32_t kVdbLayoutVersion = 2;
// Version of maps with a leaf whose scale is not 0 (vdb_scales.hpp).
inline constexpr std::int32_t kVdbScaledVersion = 3;

/// Name of the grid of rates in a file of save_hazard_vdb().
inline constexpr const char* kHazardGridName = "hazard";

/// Prefix of the names of notes (MapNotes).
inline const std::string kNotePrefix = "note_";

/// Metadata names of a class's hazard counters; missing in maps without counters.
[[nodiscard]] inline std::string expected_name(std::size_t k) {
  return "hazard_expected_" + std::to_string(k);
}
[[nodiscard]] inline std::string met_name(std::size_t k) {
  return "hazard_met_" + std::to_string(k);
}

inline void initialize_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

[[nodiscard]] inline openvdb::math::Transform::Ptr make_transform(const GridStorage& s) {
  // OpenVDB multiplies row vectors: rows are the images of the index axes, the last row is the
  // image of the origin.
  const Eigen::Matrix3d scaled = s.T_world_grid.rotation() * s.voxel_size;
  const Eigen::Vector3d origin = s.T_world_grid * Eigen::Vector3d::Constant(0.5 * s.voxel_size);
  openvdb::Mat4R m = openvdb::Mat4R::identity();
  for (int axis = 0; axis < 3; ++axis) {
    for (int r = 0; r < 3; ++r) m(axis, r) = scaled(r, axis);
    m(3, axis) = origin[axis];
  }
  return openvdb::math::Transform::createLinearTransform(m);
}

/// The map's notes by name.
[[nodiscard]] inline std::map<std::string, std::string> note_texts(
    const openvdb::MetaMap& metadata) {
  std::map<std::string, std::string> notes;
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
    const std::string& name = entry->first;
    const auto text = metadata.getMetadata<openvdb::StringMetadata>(name);
    if (name.starts_with(kNotePrefix) && text)
      notes[name.substr(kNotePrefix.size())] = text->value();
  }
  return notes;
}

/// The map's notes. Throws Error(format) with the file for invalid ones.
[[nodiscard]] inline MapNotes map_notes(const openvdb::MetaMap& metadata,
                                        const std::filesystem::path& path) {
  try {
    return notes_of(note_texts(metadata));
  } catch (const Error& error) {
    throw Error(ErrorCode::format, path.string() + ": " + error.what());
  }
}

/// Hazard counters of a file; value(name) reads an Int64Metadata. Throws like value(), and
/// Error(invalid_argument) for a count out of bounds.
template <typename Value>
[[nodiscard]] HazardCounters read_counters(const openvdb::MetaMap& metadata, Value&& value) {
  HazardCounters counters;
  if (metadata[expected_name(0)] == nullptr) return counters;  // a map without counters
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    counters.classes[k] = {value(expected_name(k)), value(met_name(k))};
  }
  check_counters(counters);
  return counters;
}

/// Name of the grid with the scales of leaves, stored in all of a leaf's voxels of the workspace;
/// present only if one is not 0. Beliefs are stored at the lowest voxels of their cells.
inline constexpr const char* kScaleGridName = "scale";

/// The voxels of a block that belong to the workspace.
[[nodiscard]] inline openvdb::CoordBBox block_box(const GridStorage& s, Index3 origin) {
  const VoxelBox part = clipped(s.lattice, origin, kBlockSize);
  return {to_coord(part.min), to_coord(part.max).offsetBy(-1)};
}

/// Whether each cell of the block has a single code, and beliefs only at lowest voxels.
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

/// Inserts an occupied tile of a file that is one cell according to the file's scales; false if it
/// is larger. Counts as eight voxels, a leaf as 512.
[[nodiscard]] inline bool put_cell(const openvdb::FloatTree& scales, const openvdb::CoordBBox& box,
                                   std::uint8_t code, SolidVoxels& solid, GridStorage& s) {
  float scale = 0;
  if (box.dim().x() != kBlockSize || !scales.probeValue(box.min(), scale)) return false;
  if (scale != float{kMaxScale}) return false;
  solid.add({0, 0, 0}, {2, 2, 2});
  s.tree.addTile(kBlockTileLevel, box.min(), code, is_non_free(code));
  return true;
}

/// Copies the scales of a file to a map that has its states and beliefs. Returns the fault, or
/// empty.
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
            << " has a scale that differs from the scale of its states and beliefs";
      return fault.str();
    }
    s.put_scale(key, scale);
    s.fold_cell(key);
    if (const BeliefBlock* block = s.find_beliefs(key)) {
      const_cast<BeliefBlock*>(block)->scale = static_cast<std::uint8_t>(scale);  // not shared
    }
  }
  return {};
}

}  // namespace viewgain::detail
