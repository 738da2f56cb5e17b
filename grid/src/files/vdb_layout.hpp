// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB keeps state in its templates: hidden, each library would have its own (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <cstddef>
#include <map>
#include <mutex>
#include <string>

#include "map/grid_layout.hpp"
#include "map/grid_storage.hpp"

// What the writer and the reader of map files share.
namespace viewgain::detail {

// The version of the layout; files of another are refused. `state` and `hits` are floats, since
// OpenVDB's Python module knows Float, Bool and Vec3S alone. A float holds whole numbers up to
// 2^24. Where a voxel has more hits, `hits` is rounded and `hits_rest`, a grid that is there only
// then, says what is to be added.
inline constexpr std::int32_t kVdbLayoutVersion = 2;
// Of maps that have a leaf whose scale is not 0 (vdb_scales.hpp).
inline constexpr std::int32_t kVdbScaledVersion = 3;

/// The grid of rates in a file of save_hazard_vdb().
inline constexpr const char* kHazardGridName = "hazard";

/// What the names of notes begin with (VdbWriteConfig::notes).
inline const std::string kNotePrefix = "note_";

/// Names of the metadata with the hazard counters of a class; maps without counters have none.
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
  // OpenVDB multiplies row vectors: rows are the images of the index axes, the last the origin's.
  const Eigen::Matrix3d scaled = s.T_world_grid.rotation() * s.voxel_size;
  const Eigen::Vector3d origin = s.T_world_grid * Eigen::Vector3d::Constant(0.5 * s.voxel_size);
  openvdb::Mat4R m = openvdb::Mat4R::identity();
  for (int axis = 0; axis < 3; ++axis) {
    for (int r = 0; r < 3; ++r) m(axis, r) = scaled(r, axis);
    m(3, axis) = origin[axis];
  }
  return openvdb::math::Transform::createLinearTransform(m);
}

/// What save_vdb() was given as notes.
[[nodiscard]] inline std::map<std::string, std::string> notes_of(const openvdb::MetaMap& metadata) {
  std::map<std::string, std::string> notes;
  for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
    const std::string& name = entry->first;
    const auto text = metadata.getMetadata<openvdb::StringMetadata>(name);
    if (name.starts_with(kNotePrefix) && text)
      notes[name.substr(kNotePrefix.size())] = text->value();
  }
  return notes;
}

/// The hazard counters of a file; value(name) reads an Int64Metadata. Throws as it does, and
/// Error(invalid_argument) for a count that is out of bounds.
template <typename Value>
[[nodiscard]] HazardCounters read_counters(const openvdb::MetaMap& metadata, Value&& value) {
  HazardCounters counters;
  if (metadata[expected_name(0)] == nullptr) return counters;  // a map without
  for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
    counters.classes[k] = {value(expected_name(k)), value(met_name(k))};
  }
  check_counters(counters);
  return counters;
}

}  // namespace viewgain::detail
