// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain::detail {

/// Properties of a file, known before reading it.
struct VdbOutline {
  std::string fault;             ///< empty if there is no fault
  std::uint64_t tree_bytes = 0;  ///< maximum memory of the trees
};

/// Parses an OpenVDB file as OpenVDB's reader would, and reports faults. That reader does not check
/// for short reads, leaks on exceptions, and allocates any size stated in the file. After this
/// check no size exceeds the rest of the file, so trees take at most about fifty times its bytes.
/// Skips grids of other types than is_followed() by their positions. Changes the metadata for
/// delayed loading to a type unknown to OpenVDB, which only copies it. Cost: one pass over the
/// masks of the trees.
[[nodiscard]] VdbOutline outline_of(std::string& image);

/// Whether grids of this type are checked; others must not be read.
[[nodiscard]] bool is_followed(std::string_view grid_type);

}  // namespace viewgain::detail
