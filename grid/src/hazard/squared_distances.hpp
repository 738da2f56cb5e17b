// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace viewgain::detail {

/// Above every squared distance that is found.
inline constexpr std::uint16_t kNoDistance = 0xFFFF;

/// Replaces 0 (something is here) and kNoDistance in a dense array [x][y][z], z fastest, by the
/// squared Euclidean distance to the nearest 0 [cells²], exactly; kNoDistance beyond `reach`, at
/// most 127. Costs reach × cells / 4 steps of 16 cells or so.
void find_squared_distances(std::vector<std::uint16_t>& cells,
                            const std::array<std::size_t, 3>& size, int reach);

}  // namespace viewgain::detail
