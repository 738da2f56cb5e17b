// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "classic_table.hpp"

#include <algorithm>
#include <optional>

#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kBrickVoxels = 512;
// Rows of a brick along z with a margin of one voxel on each side: bit k is z - 1 + k.
constexpr int kRows = 10;
using Rows = std::array<std::array<std::uint16_t, kRows>, kRows>;

std::uint32_t word_of(std::uint8_t code) {
  return code == kUnknownCode ? ClassicTable::kUnknown : code;
}

// Adds the 26 neighbours of each voxel.
Rows dilated(const Rows& rows) {
  Rows along_z{}, along_y{}, all{};
  for (std::size_t x = 0; x < kRows; ++x) {
    for (std::size_t y = 0; y < kRows; ++y) {
      const unsigned row = rows[x][y];
      along_z[x][y] = static_cast<std::uint16_t>(row | row << 1U | row >> 1U);
    }
  }
  for (std::size_t x = 0; x < kRows; ++x) {
    for (std::size_t y = 1; y + 1 < kRows; ++y) {
      along_y[x][y] =
          static_cast<std::uint16_t>(along_z[x][y - 1] | along_z[x][y] | along_z[x][y + 1]);
    }
  }
  for (std::size_t x = 1; x + 1 < kRows; ++x) {
    for (std::size_t y = 1; y + 1 < kRows; ++y) {
      all[x][y] = static_cast<std::uint16_t>(along_y[x - 1][y] | along_y[x][y] | along_y[x + 1][y]);
    }
  }
  return all;
}

// Stores in each word of a mixed brick the size of the uniform cube around it.
void find_cubes_in_brick(std::uint16_t* words) {
  std::for_each_n(words, kBrickVoxels, [](std::uint16_t& word) {
    word = static_cast<std::uint16_t>(word & ClassicTable::kValue);
  });
  widen_cubes(
      8, 4,
      [&](unsigned x, unsigned y, unsigned z) -> std::uint16_t& {
        return words[ClassicTable::word_in_brick(x, y, z)];
      },
      [](std::uint32_t word, unsigned edge) -> std::optional<std::uint16_t> {
        if (ClassicTable::edge(word) * 2 != static_cast<std::int32_t>(edge)) return std::nullopt;
        return static_cast<std::uint16_t>(word + (1U << ClassicTable::kEdgeShift));
      });
}

// The same for uniform bricks of a node.
void find_cubes_in_node(std::uint32_t* entries) {
  std::for_each_n(entries, BrickIndex::kEntries, [](std::uint32_t& entry) {
    if ((entry & ClassicTable::kUniform) == 0) return;
    entry =
        ClassicTable::kUniform | (entry & ClassicTable::kValue) | 3U << ClassicTable::kEdgeShift;
  });
  widen_cubes(
      16, 1U << (ClassicTable::kLargestShift - 3U),
      [&](unsigned x, unsigned y, unsigned z) -> std::uint32_t& {
        return entries[x << 8U | y << 4U | z];
      },
      [](std::uint32_t entry, unsigned edge) -> std::optional<std::uint32_t> {
        if ((entry & ClassicTable::kUniform) == 0 ||
            ClassicTable::edge(entry) != static_cast<std::int32_t>(edge) * BrickIndex::kBrick / 2) {
          return std::nullopt;
        }
        return entry + (1U << ClassicTable::kEdgeShift);
      });
}

}  // namespace

ClassicTable::ClassicTable(const BeliefGrid& grid)
    : BrickIndex(grid.min_index(), grid.dims(), kUniform | word_of(kUnknownCode)),
      words(kBrickVoxels, 0) {
  std::vector<Index3> with_occupied;
  const auto fill = [&](const VoxelBox& box, std::uint8_t code) {
    const std::uint32_t uniform = kUniform | word_of(code);
    put(
        box, [&](Index3) { return std::optional(uniform); }, [&](Index3) { return uniform; });
  };
  visit_grid(
      grid,
      [&](Index3 origin, const std::uint8_t* codes) {
        const Index3 brick = in_table(origin);
        if (std::any_of(codes, codes + kBrickVoxels,
                        [](std::uint8_t c) { return c > kZeroCode; })) {
          with_occupied.push_back(brick);
        }
        if (std::all_of(codes, codes + kBrickVoxels, [&](std::uint8_t c) { return c == *codes; })) {
          return fill(VoxelBox::from_dims(brick, {kBrick, kBrick, kBrick}), *codes);
        }
        std::uint16_t* own = own_words(brick);
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
          own[word_in_brick(i >> 6U, i >> 3U, i)] = static_cast<std::uint16_t>(word_of(codes[i]));
        }
      },
      [&](Index3 origin, std::int32_t edge, std::uint8_t code) {
        fill(VoxelBox::from_dims(in_table(origin), {edge, edge, edge}), code);
      });
  find_frontiers(with_occupied);
  find_cubes();
}

// Unknown voxels with a free and an occupied neighbour lie in bricks next to occupied voxels.
void ClassicTable::find_frontiers(const std::vector<Index3>& with_occupied) {
  std::vector<std::array<std::int32_t, 3>> places;
  for (const Index3& brick : with_occupied) {
    for (int i = 0; i < 27; ++i) {
      const Index3 at{brick.x + (i / 9 - 1) * kBrick, brick.y + (i / 3 % 3 - 1) * kBrick,
                      brick.z + (i % 3 - 1) * kBrick};
      const VoxelBox box = VoxelBox::from_dims(at, {kBrick, kBrick, kBrick});
      if (box.intersection(workspace()).volume() > 0) places.push_back({at.x, at.y, at.z});
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  // Frontier marks do not change codes, so the order does not matter.
  for (const auto& [x, y, z] : places) mark_frontiers({x, y, z});
}

void ClassicTable::mark_frontiers(Index3 brick) {
  Rows free{}, occupied{};
  const std::array<std::int32_t, 3> low{brick.x - 1, brick.y - 1, brick.z - 1};
  const auto is_inside = [&](std::int32_t v, std::size_t a) {
    return v >= offset[a] && v < offset[a] + size[a];
  };
  for (std::int32_t x = 0; x < kRows; ++x) {
    if (!is_inside(low[0] + x, 0)) continue;
    for (std::int32_t y = 0; y < kRows; ++y) {
      if (!is_inside(low[1] + y, 1)) continue;
      unsigned free_row = 0, occupied_row = 0;
      for (std::int32_t z = 0; z < kRows; ++z) {
        if (!is_inside(low[2] + z, 2)) continue;
        const std::uint32_t at = word(low[0] + x, low[1] + y, low[2] + z);
        if (is_occupied(at)) {
          occupied_row |= 1U << z;
        } else if (!is_unknown(at)) {
          free_row |= 1U << z;
        }
      }
      free[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] =
          static_cast<std::uint16_t>(free_row);
      occupied[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] =
          static_cast<std::uint16_t>(occupied_row);
    }
  }
  const Rows near_free = dilated(free), near_occupied = dilated(occupied);
  std::uint16_t* own = nullptr;
  for (std::int32_t x = 0; x < 8; ++x) {
    for (std::int32_t y = 0; y < 8; ++y) {
      const auto i = static_cast<std::size_t>(x + 1), j = static_cast<std::size_t>(y + 1);
      const unsigned row = near_free[i][j] & near_occupied[i][j];
      if (row == 0) continue;
      for (std::int32_t z = 0; z < 8; ++z) {
        if ((row >> (z + 1) & 1U) == 0 || !is_inside(low[0] + 1 + x, 0) ||
            !is_inside(low[1] + 1 + y, 1) || !is_inside(low[2] + 1 + z, 2)) {
          continue;
        }
        if (!is_unknown(word(low[0] + 1 + x, low[1] + 1 + y, low[2] + 1 + z))) continue;
        if (own == nullptr) own = own_words(brick);
        std::uint16_t& at =
            own[word_in_brick(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                              static_cast<std::uint32_t>(z))];
        at = static_cast<std::uint16_t>(at | kFrontier);
      }
    }
  }
}

// The words of a brick, which becomes a mixed one.
std::uint16_t* ClassicTable::own_words(Index3 brick) {
  std::uint32_t& entry = own_entry(brick.x, brick.y, brick.z);
  if ((entry & kUniform) != 0) {
    const auto value = static_cast<std::uint16_t>(entry & kValue);
    check_capacity(words.size() + kBrickVoxels);
    entry = static_cast<std::uint32_t>(words.size());
    words.resize(words.size() + kBrickVoxels, value);
  }
  return &words[entry];
}

void ClassicTable::find_cubes() {
  for (std::size_t first = kBrickVoxels; first < words.size(); first += kBrickVoxels) {
    find_cubes_in_brick(&words[first]);
  }
  for (std::size_t first = 0; first < entries.size(); first += kEntries) {
    find_cubes_in_node(&entries[first]);
  }
}

void ClassicTable::add(const OcclusionSteps& steps) {
  for (const auto& [place, brick] : steps.bricks()) {
    std::uint16_t* own = own_words({place[0] * kBrick, place[1] * kBrick, place[2] * kBrick});
    for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
      std::uint16_t& word = own[word_in_brick(i >> 6U, i >> 3U, i)];
      word = static_cast<std::uint16_t>(word | std::uint32_t{(*brick)[i]} << kStepsShift);
    }
  }
  find_cubes();
}

}  // namespace viewgain::detail
