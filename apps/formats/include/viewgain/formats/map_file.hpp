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
/// Map files. The cost of reading and writing grows with the leaves and beliefs of the map;
/// functions that only inspect a name take constant time.

namespace viewgain {

/// Whether the name ends in .ot or .bt, in lower or upper case. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT bool is_octomap(const std::filesystem::path& path);

/// Path of the map in the folder of a run: map.vdb, else state.vdb, which need not exist. Returns
/// any other path unchanged.
[[nodiscard]] VIEWGAIN_EXPORT std::filesystem::path map_in(const std::filesystem::path& path);

/// Reads a .vdb map, the map of a run's folder (map_in()), or an OctoMap tree with `config`. If a
/// sensor is given, it determines the default of config.prior_sigma. Throws Error(format) with file
/// and key if the map's note of its sensor is invalid. Also throws whatever load_vdb() and
/// load_octomap() throw.
[[nodiscard]] VIEWGAIN_EXPORT BeliefGrid load_map(const std::filesystem::path& file_or_run,
                                                  const Sensor* sensor = nullptr,
                                                  OctomapConfig config = {},
                                                  const ExecConfig& exec = {});

/// The sensor of all readings of a map, if known (MapNotes::sensor). Throws Error(format) with the
/// key for an invalid note. Cost: parses the note.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<Sensor> map_sensor(const BeliefGrid& grid);

/// Throws Error(invalid_argument) for names that save_map() does not write: names of regular files
/// that end neither in .vdb nor in .ot.
VIEWGAIN_EXPORT void check_map_name(const std::filesystem::path& path);

/// Contents of a map that were lost because a .ot file cannot store them.
struct VIEWGAIN_EXPORT LostInTree {
  std::size_t beliefs = 0;       ///< number of voxels whose beliefs were lost
  std::size_t views = 0;         ///< number of lost views
  bool hazard_counters = false;  ///< whether hazard counters were lost
  bool T_world_grid = false;     ///< whether this pose was lost; see octomap_keeps_frame()
};

/// Writes a .ot if the name ends in .ot, otherwise a .vdb, which loses nothing. Atomic. Throws
/// whatever save_vdb(), save_octomap() and check_map_name() throw.
VIEWGAIN_EXPORT LostInTree save_map(const BeliefGrid& grid, const std::filesystem::path& path,
                                    const VdbWriteConfig& config = {});

}  // namespace viewgain
