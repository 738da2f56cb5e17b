// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "tile_sample.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "gain/batch_loop.hpp"
#include "viewgain/core/mix64.hpp"

namespace viewgain::detail {
namespace {

// Irrational steps of a two-dimensional sequence whose points keep apart: 1/g and 1/g², g³ = g + 1.
constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;

// The gain of each group.
struct GroupConsumer : GainConsumer {
  double* gain;

  void finish(ViewGain& result) {
    GainConsumer::finish(result);
    *gain++ = result.gain;
  }
};

}  // namespace

std::vector<std::vector<std::uint32_t>> random_tiles(const TileTable& table, std::size_t groups,
                                                     std::size_t per_group, std::uint64_t seed) {
  const auto columns = static_cast<std::size_t>((table.columns + kTileEdge - 1) / kTileEdge);
  const std::size_t rows = table.tile_count / columns;
  const std::size_t count = std::min(groups * per_group, table.tile_count);
  std::vector<std::uint32_t> tiles;
  std::vector<std::uint8_t> taken(table.tile_count, 0);
  const std::uint64_t start = mix64(seed);
  double x = unit_number(mix64(start)), y = unit_number(mix64(start + 1));
  // The sequence comes by every tile sooner or later; the last few are taken as they stand.
  for (std::size_t i = 0; tiles.size() < count && i < 16 * table.tile_count; ++i) {
    const std::size_t tile =
        std::min(static_cast<std::size_t>(y * static_cast<double>(rows)), rows - 1) * columns +
        std::min(static_cast<std::size_t>(x * static_cast<double>(columns)), columns - 1);
    if (taken[tile] == 0) tiles.push_back(static_cast<std::uint32_t>(tile));
    taken[tile] = 1;
    x += kStepX, y += kStepY;
    x -= std::floor(x), y -= std::floor(y);
  }
  for (std::uint32_t tile = 0; tiles.size() < count; ++tile) {
    if (taken[tile] == 0) tiles.push_back(tile);
  }
  std::vector<std::vector<std::uint32_t>> dealt(groups);
  // None is empty, if the view has so few tiles that one must be in several.
  for (std::size_t i = 0; i < std::max(count, groups); ++i) {
    dealt[i % groups].push_back(tiles[i % count]);
  }
  return dealt;
}

std::uint64_t rays_of(const TileTable& table, std::span<const std::uint32_t> tiles) {
  std::uint64_t rays = 0;
  for (const std::uint32_t tile : tiles) {
    rays += static_cast<std::uint64_t>(std::popcount(table.valid[tile]));
  }
  return rays;
}

void sample(const ViewDriver& driver, const Pose& T_world_camera,
            std::span<const std::vector<std::uint32_t>> groups, std::span<double> gains,
            ViewDriver::Lease& lease) {
  ViewGain result;
  if (const SurfaceView* surface = driver.surface()) {
    if (const auto frame = driver.open(T_world_camera, result)) {
      surface->sample(*frame, groups, lease.workspace(), gains);
    } else {
      std::fill(gains.begin(), gains.end(), result.gain);
    }
    return;
  }
  GroupConsumer consumer{{lease.accumulator()}, gains.data()};
  if (!driver.groups(T_world_camera, groups, lease, result, consumer)) {
    std::fill(gains.begin(), gains.end(), result.gain);
  }
}

bool evaluate_some(const ViewDriver& driver, std::span<const Pose> T_world_camera,
                   std::span<const std::size_t> indices, std::span<ViewGain> results,
                   const BatchControl& control) {
  return for_each(driver, indices.size(), control, [&](std::size_t j, ViewDriver::Lease& lease) {
    results[j] = driver.evaluate(T_world_camera[indices[j]], lease);
  });
}

}  // namespace viewgain::detail
