// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "trace/ray_tile.hpp"

namespace viewgain::bench {

/// The distinct primitives in which the rays of a traced tile end, in the order of the lanes.
[[nodiscard]] inline std::vector<std::uint32_t> hit_boxes(const detail::RayTile& tile) {
  std::vector<std::uint32_t> boxes;
  for (std::size_t lane = 0; lane < detail::kTileRays; ++lane) {
    if ((tile.hit >> lane & 1U) == 0) continue;
    const auto is_same = [&](std::uint32_t b) { return b == tile.primitive[lane]; };
    if (std::none_of(boxes.begin(), boxes.end(), is_same)) {
      boxes.push_back(tile.primitive[lane]);
    }
  }
  return boxes;
}

}  // namespace viewgain::bench
