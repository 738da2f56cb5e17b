// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"

/// @file
/// Files of maps. Cost of reading and writing: grows with the leaves and beliefs of the map;
/// functions that look at a name take constant time.

namespace viewgain {

/// Whether the name ends in .ot or .bt, in small or capital letters. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_octomap(const std::filesystem::path& path);

/// The map in the folder of a run: map.vdb, else state.vdb, there or not. What is no folder stays.
[[nodiscard]] VIEWGAIN_EXPORT std::filesystem::path map_in(const std::filesystem::path& path);

/// Reads a .vdb map, that of a run's folder (map_in()), or an OctoMap tree by `config`, whose prior
/// is, unless given, the default for the sensor where there is one. Throws what load_vdb and
/// load_octomap throw, and Error(format), naming the file and the key, if the map's note of its
/// sensor is none.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_map(const std::filesystem::path& file_or_run,
                                                  const Sensor* sensor = nullptr,
                                                  OctomapConfig config = {},
                                                  const ExecConfig& exec = {});

/// The sensor that all readings of a map come from, if that is known (MapNotes::sensor). Throws
/// Error(format), naming the key, for a note that is no sensor. Cost: parses the note.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Sensor> map_sensor(const BeliefGrid& grid);

/// Throws Error(invalid_argument) for names that save_map does not write: those that end neither in
/// .vdb nor in .ot, unless what is there is no regular file (/dev/null, a pipe).
VIEWGAIN_EXPORT void check_map_name(const std::filesystem::path& path);

/// What a map has and its tree has not.
struct VIEWGAIN_EXPORT LostInTree {
  std::size_t beliefs = 0;       ///< voxels
  std::size_t views = 0;         ///< how many
  bool hazard_counters = false;  ///< were there any
  bool T_world_grid = false;     ///< see octomap_keeps_frame
};

/// Writes a .ot for a name that ends so, else a .vdb, of which nothing is lost. Atomic. Throws what
/// save_vdb and save_octomap throw, and as check_map_name().
VIEWGAIN_EXPORT LostInTree save_map(const BeliefGrid& grid, const std::filesystem::path& path,
                                    const VdbWriteConfig& config = {});

}  // namespace viewgain
