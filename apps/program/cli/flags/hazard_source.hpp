// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain::app {

/// Is the value of --hazard a file of rates? By its ending, .vdb.
[[nodiscard]] bool is_hazard_file(const std::string& value);

/// What --hazard and --object-size [m] say of a map's unknown space: nothing (empty: the default
/// by distance), a rate [1/m] that is the same everywhere, or a .vdb file of rates
/// (load_hazard_vdb). Throws Error(invalid_argument) for a text that is neither, and as
/// load_hazard_vdb().
[[nodiscard]] HazardConfig hazard_source(const std::string& hazard,
                                         std::optional<double> object_size, const BeliefGrid& grid);

inline constexpr const char* kHazardHelp =
    "of the surface and combined gain: rate at which rays meet the surface in unknown voxels "
    "[1/m], the same everywhere, or a .vdb file of such rates; default: by the distance from what "
    "is seen";
inline constexpr const char* kObjectSizeHelp =
    "of the surface and combined gain: longest side of the object [m]; default: that of what is "
    "seen of it";

}  // namespace viewgain::app
