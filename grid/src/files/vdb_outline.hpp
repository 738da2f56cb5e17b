// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace viewgain::detail {

/// What a file is, before it is read.
struct VdbOutline {
  std::string fault;             ///< empty if there is none
  std::uint64_t tree_bytes = 0;  ///< at most, of the trees in memory
};

/// Follows an OpenVDB file as OpenVDB's reader will, and says what is wrong with it.
/// That reader neither notices a read that came short nor cleans up after an exception, and takes
/// what memory a size in the file asks for. After this no size is larger than what there is of the
/// file: its trees take some fifty times its bytes at most. Grids of other types than is_followed()
/// are passed over, by their positions. What delays loading becomes metadata of a type that OpenVDB
/// does not know, which it only copies. Costs a look at every mask of the trees.
[[nodiscard]] VdbOutline outline_of(std::string& image);

/// Grids of this type have been followed, others must not be read.
[[nodiscard]] bool is_followed(std::string_view grid_type);

}  // namespace viewgain::detail
