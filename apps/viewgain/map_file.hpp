// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/octomap_io.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain::app {

inline constexpr const char* kMapHelp = "map (.vdb, or OctoMap's .ot or .bt)";

/// Whether the name ends in .ot or .bt.
[[nodiscard]] bool is_octomap(const std::filesystem::path& path);

/// Reads a .vdb map, or an OctoMap tree by `config`, whose prior is, unless given, the default for
/// the sensor where there is one. Throws what load_vdb and load_octomap throw.
[[nodiscard]] BeliefGrid load_map(const std::filesystem::path& path, const Sensor* sensor = nullptr,
                                  OctomapConfig config = {});

/// Throws Error(invalid_argument) for names that save_map does not write: .bt.
void check_map_name(const std::filesystem::path& path);

/// Writes a .ot for a name that ends so, else a .vdb.
void save_map(const BeliefGrid& grid, const std::filesystem::path& path,
              const VdbWriteConfig& config = {});

}  // namespace viewgain::app
