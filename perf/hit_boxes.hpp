// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "trace/ray_tile.hpp"
#include "trace/tile_bins.hpp"

namespace viewgain::bench {

/// The distinct primitives that a traced tile's rays end in, in the order of the lanes, as the
/// kernel's walk takes them.
[[nodiscard]] inline std::vector<detail::TileBox> hit_boxes(const detail::RayTile& tile) {
  std::vector<detail::TileBox> boxes;
  for (std::size_t lane = 0; lane < detail::kTileRays; ++lane) {
    if ((tile.hit >> lane & 1U) == 0) continue;
    const auto is_same = [&](const detail::TileBox& b) { return b.box == tile.primitive[lane]; };
    if (std::none_of(boxes.begin(), boxes.end(), is_same)) {
      boxes.push_back({tile.primitive[lane], 0.0F});
    }
  }
  return boxes;
}

}  // namespace viewgain::bench
