// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "classic_table.hpp"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kEntriesPerNode = 4096, kBrickVoxels = 512;
constexpr int kNodeBricks = 16;
// The rows of a brick along z with a voxel more at each side: bit k is z - 1 + k.
constexpr int kRows = 10;
using Rows = std::array<std::array<std::uint16_t, kRows>, kRows>;

// Gathers have indices of 32 bits with a sign.
void check_capacity(std::size_t size) {
  if (size > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw Error(ErrorCode::capacity, "the map is too large for classic gains");
  }
}

std::uint16_t word_of(std::uint32_t code) {
  return static_cast<std::uint16_t>(code == OccupancyCodes::kUnknown ? ClassicTable::kUnknown
                                                                     : code);
}

// Every voxel with what is within one voxel of it.
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

class Maker {
 public:
  Maker(const OccupancyCodes& codes, ClassicTable& table) : codes_(codes), table_(table) {}

  void run() {
    table_.words.assign(kBrickVoxels, 0);
    for (std::size_t node = 0; node < codes_.node_entries.size(); ++node) {
      const std::uint32_t from = codes_.node_entries[node];
      if ((from & OccupancyCodes::kUniform) != 0) {
        table_.node_entries.push_back(uniform_node(from & 0xFFU));
        continue;
      }
      const std::size_t first = table_.entries.size();
      check_capacity(first + kEntriesPerNode);
      table_.node_entries.push_back(static_cast<std::uint32_t>(first));
      table_.entries.resize(first + kEntriesPerNode);
      for (std::size_t i = 0; i < kEntriesPerNode; ++i) {
        table_.entries[first + i] = entry_of(codes_.entries[from + i]);
      }
    }
    find_frontiers();
  }

 private:
  // Nodes that are the same throughout share entries.
  std::uint32_t uniform_node(std::uint32_t code) {
    const auto [found, is_new] =
        uniform_nodes_.emplace(code, static_cast<std::uint32_t>(table_.entries.size()));
    if (is_new) {
      check_capacity(table_.entries.size() + kEntriesPerNode);
      table_.entries.resize(table_.entries.size() + kEntriesPerNode,
                            ClassicTable::kUniform | word_of(code));
    }
    return found->second;
  }

  std::uint32_t entry_of(std::uint32_t from) {
    if ((from & OccupancyCodes::kUniform) != 0)
      return ClassicTable::kUniform | word_of(from & 0xFFU);
    const std::size_t first = table_.words.size();
    check_capacity(first + kBrickVoxels);
    const std::uint8_t* codes = codes_.codes.data() + from;
    table_.words.resize(first + kBrickVoxels);
    for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
      table_.words[first + ClassicTable::word_in_brick(i >> 6U, i >> 3U, i)] = word_of(codes[i]);
    }
    return static_cast<std::uint32_t>(first);
  }

  // Unknown voxels with a free and an occupied neighbour lie in bricks next to occupied voxels.
  void find_frontiers() {
    std::vector<Index3> with_occupied;
    for_each_mixed([&](Index3 brick, std::uint32_t first) {
      const auto begin = table_.words.begin() + first;
      if (std::any_of(begin, begin + kBrickVoxels, ClassicTable::is_occupied)) {
        with_occupied.push_back(brick);
      }
    });
    std::vector<std::array<std::int32_t, 3>> places;
    for (const Index3& brick : with_occupied) {
      for (int i = 0; i < 27; ++i) {
        const std::array<std::int32_t, 3> place{brick.x + i / 9 - 1, brick.y + i / 3 % 3 - 1,
                                                brick.z + i % 3 - 1};
        if (is_in_workspace(place)) places.push_back(place);
      }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    // What is put into the table does not change codes, so the order does not matter.
    for (const auto& [x, y, z] : places) mark_frontiers({x, y, z});
  }

  [[nodiscard]] bool is_in_workspace(const std::array<std::int32_t, 3>& brick) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (brick[a] < 0 || brick[a] * 8 >= table_.offset[a] + table_.size[a]) return false;
    }
    return true;
  }

  template <typename Visit>
  void for_each_mixed(Visit&& visit) const {
    for (int nx = 0; nx < table_.nodes[0]; ++nx) {
      for (int ny = 0; ny < table_.nodes[1]; ++ny) {
        for (int nz = 0; nz < table_.nodes[2]; ++nz) {
          const std::uint32_t first =
              table_.node_entries[table_.node_index(nx * 128, ny * 128, nz * 128)];
          for (int i = 0; i < static_cast<int>(kEntriesPerNode); ++i) {
            const std::uint32_t entry = table_.entries[first + static_cast<std::uint32_t>(i)];
            if ((entry & ClassicTable::kUniform) != 0) continue;
            visit(Index3{nx * kNodeBricks + i / 256, ny * kNodeBricks + i / 16 % 16,
                         nz * kNodeBricks + i % 16},
                  entry);
          }
        }
      }
    }
  }

  void mark_frontiers(Index3 brick) {
    Rows free{}, occupied{};
    const std::array<std::int32_t, 3> low{brick.x * 8 - 1, brick.y * 8 - 1, brick.z * 8 - 1};
    const auto is_inside = [&](std::int32_t v, std::size_t a) {
      return v >= table_.offset[a] && v < table_.offset[a] + table_.size[a];
    };
    for (std::int32_t x = 0; x < kRows; ++x) {
      if (!is_inside(low[0] + x, 0)) continue;
      for (std::int32_t y = 0; y < kRows; ++y) {
        if (!is_inside(low[1] + y, 1)) continue;
        unsigned free_row = 0, occupied_row = 0;
        for (std::int32_t z = 0; z < kRows; ++z) {
          if (!is_inside(low[2] + z, 2)) continue;
          const std::uint32_t word = table_.word(low[0] + x, low[1] + y, low[2] + z);
          if (ClassicTable::is_occupied(word)) {
            occupied_row |= 1U << z;
          } else if (!ClassicTable::is_unknown(word)) {
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
          if (ClassicTable::is_unknown(
                  table_.word(low[0] + 1 + x, low[1] + 1 + y, low[2] + 1 + z))) {
            if (own == nullptr) own = own_words(table_, brick);
            std::uint16_t& word = own[ClassicTable::word_in_brick(static_cast<std::uint32_t>(x),
                                                                  static_cast<std::uint32_t>(y),
                                                                  static_cast<std::uint32_t>(z))];
            word = static_cast<std::uint16_t>(word | ClassicTable::kFrontier);
          }
        }
      }
    }
  }

 public:
  // The words of a brick; it becomes a mixed one. Not in a node whose entries others share.
  static std::uint16_t* own_words(ClassicTable& table, Index3 brick) {
    std::uint32_t& node =
        table.node_entries[table.node_index(brick.x * 8, brick.y * 8, brick.z * 8)];
    const std::uint32_t word = table.entries[node];
    const auto begin = table.entries.begin() + node;
    // A node all of whose entries are one uniform word may be shared.
    if ((word & ClassicTable::kUniform) != 0 &&
        std::all_of(begin, begin + kEntriesPerNode, [&](std::uint32_t e) { return e == word; })) {
      check_capacity(table.entries.size() + kEntriesPerNode);
      node = static_cast<std::uint32_t>(table.entries.size());
      table.entries.resize(table.entries.size() + kEntriesPerNode, word);
    }
    std::uint32_t& entry = table.entries[table.entry_index(brick.x * 8, brick.y * 8, brick.z * 8)];
    if ((entry & ClassicTable::kUniform) != 0) {
      const auto value = static_cast<std::uint16_t>(entry & ClassicTable::kValue);
      check_capacity(table.words.size() + kBrickVoxels);
      entry = static_cast<std::uint32_t>(table.words.size());
      table.words.resize(table.words.size() + kBrickVoxels, value);
    }
    return &table.words[entry];
  }

 private:
  const OccupancyCodes& codes_;
  ClassicTable& table_;
  std::unordered_map<std::uint32_t, std::uint32_t> uniform_nodes_;
};

// Tells the words of a mixed brick how large the cubes of one value are round them.
void find_cubes_in_brick(std::uint16_t* words) {
  const auto at = [&](unsigned x, unsigned y, unsigned z) -> std::uint16_t& {
    return words[ClassicTable::word_in_brick(x, y, z)];
  };
  for (std::size_t i = 0; i < kBrickVoxels; ++i) {
    words[i] = static_cast<std::uint16_t>(words[i] & ClassicTable::kValue);
  }
  for (unsigned shift = 1; shift < 3; ++shift) {
    const unsigned edge = 1U << shift, half = edge / 2;
    for (unsigned x = 0; x < 8; x += edge) {
      for (unsigned y = 0; y < 8; y += edge) {
        for (unsigned z = 0; z < 8; z += edge) {
          const std::uint32_t word = at(x, y, z);
          bool same = word >> ClassicTable::kEdgeShift == shift - 1;
          for (unsigned k = 1; k < 8 && same; ++k) {
            same = at(x + (k >> 2U) * half, y + (k >> 1U & 1U) * half, z + (k & 1U) * half) == word;
          }
          if (!same) continue;
          const auto wide = static_cast<std::uint16_t>((word & ClassicTable::kValue) |
                                                       shift << ClassicTable::kEdgeShift);
          for (unsigned i = x; i < x + edge; ++i) {
            for (unsigned j = y; j < y + edge; ++j) {
              for (unsigned k = z; k < z + edge; ++k) at(i, j, k) = wide;
            }
          }
        }
      }
    }
  }
}

// The same for the uniform bricks of a node.
void find_cubes_in_node(std::uint32_t* entries) {
  for (std::size_t i = 0; i < kEntriesPerNode; ++i) {
    if ((entries[i] & ClassicTable::kUniform) == 0) continue;
    entries[i] = ClassicTable::kUniform | (entries[i] & ClassicTable::kValue) |
                 3U << ClassicTable::kEdgeShift;
  }
  for (unsigned shift = 4; shift <= ClassicTable::kLargestShift; ++shift) {
    const unsigned edge = 1U << (shift - 3U), half = edge / 2;  // in bricks
    for (unsigned x = 0; x < 16; x += edge) {
      for (unsigned y = 0; y < 16; y += edge) {
        for (unsigned z = 0; z < 16; z += edge) {
          const std::uint32_t entry = entries[x << 8U | y << 4U | z];
          if ((entry & ClassicTable::kUniform) == 0) continue;
          bool same = (entry >> ClassicTable::kEdgeShift & ClassicTable::kEdge) == shift - 1;
          for (unsigned k = 1; k < 8 && same; ++k) {
            same = entries[(x + (k >> 2U) * half) << 8U | (y + (k >> 1U & 1U) * half) << 4U |
                           (z + (k & 1U) * half)] == entry;
          }
          if (!same) continue;
          const std::uint32_t wide = ClassicTable::kUniform | (entry & ClassicTable::kValue) |
                                     shift << ClassicTable::kEdgeShift;
          for (unsigned i = x; i < x + edge; ++i) {
            for (unsigned j = y; j < y + edge; ++j) {
              for (unsigned k = z; k < z + edge; ++k) entries[i << 8U | j << 4U | k] = wide;
            }
          }
        }
      }
    }
  }
}

void find_cubes(ClassicTable& table) {
  for (std::size_t first = kBrickVoxels; first < table.words.size(); first += kBrickVoxels) {
    find_cubes_in_brick(&table.words[first]);
  }
  for (std::size_t first = 0; first < table.entries.size(); first += kEntriesPerNode) {
    find_cubes_in_node(&table.entries[first]);
  }
}

}  // namespace

ClassicTable::ClassicTable(const OccupancyCodes& codes)
    : base{codes.first_brick.x * 8, codes.first_brick.y * 8, codes.first_brick.z * 8},
      offset{codes.min_index.x - base.x, codes.min_index.y - base.y, codes.min_index.z - base.z},
      size{codes.dims.x, codes.dims.y, codes.dims.z},
      nodes(codes.nodes) {
  Maker(codes, *this).run();
  find_cubes(*this);
}

void ClassicTable::add(const OcclusionSteps& steps) {
  for (const auto& [place, brick] : steps.bricks()) {
    std::uint16_t* own = Maker::own_words(*this, {place[0], place[1], place[2]});
    for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
      std::uint16_t& word = own[word_in_brick(i >> 6U, i >> 3U, i)];
      word = static_cast<std::uint16_t>(word | std::uint32_t{(*brick)[i]} << kStepsShift);
    }
  }
  find_cubes(*this);
}

}  // namespace viewgain::detail
