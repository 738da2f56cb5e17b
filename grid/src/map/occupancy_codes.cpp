// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/occupancy_codes.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/grid_blocks.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr std::size_t kEntriesPerNode = 4096;
constexpr std::size_t kMostNodes = std::size_t{1} << 24U;
static_assert(OccupancyCodes::kUnknown == kUnknownCode && OccupancyCodes::kCount == kMaxCode + 1);
static_assert(OccupancyCodes::kBrick == kBlockSize &&
              OccupancyCodes::kBrick * OccupancyCodes::kNode == kNodeSize);

void check_capacity(std::size_t size) {
  if (size > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw Error(ErrorCode::capacity, "the map is too large for a table of its log-odds");
  }
}

std::size_t brick_in_node(Index3 brick) {
  return static_cast<std::size_t>((brick.x & 15) << 8 | (brick.y & 15) << 4 | (brick.z & 15));
}

class Filler {
 public:
  explicit Filler(OccupancyCodes& table) : table_(table) {}

  void put(Index3 origin, const std::uint8_t* codes) {
    if (std::all_of(codes, codes + kBlockVoxels, [&](std::uint8_t c) { return c == *codes; })) {
      fill(origin, kBlockSize, *codes);
      return;
    }
    std::uint32_t& entry = entry_of(brick_at(origin));
    check_capacity(table_.codes.size() + kBlockVoxels);
    entry = static_cast<std::uint32_t>(table_.codes.size());
    table_.codes.insert(table_.codes.end(), codes, codes + kBlockVoxels);
  }

  void fill(Index3 origin, std::int32_t size, std::uint8_t code) {
    const VoxelBox workspace = VoxelBox::from_dims(table_.min_index, table_.dims);
    const VoxelBox part = workspace.intersection(VoxelBox::from_dims(origin, {size, size, size}));
    const Index3 low = brick_at(part.min),
                 last = brick_at({part.max.x - 1, part.max.y - 1, part.max.z - 1});
    const std::uint32_t uniform = OccupancyCodes::kUniform | code;
    for (std::int32_t nx = low.x >> 4; nx <= last.x >> 4; ++nx) {
      for (std::int32_t ny = low.y >> 4; ny <= last.y >> 4; ++ny) {
        for (std::int32_t nz = low.z >> 4; nz <= last.z >> 4; ++nz) {
          const VoxelBox node{{nx * 16, ny * 16, nz * 16},
                              {nx * 16 + 16, ny * 16 + 16, nz * 16 + 16}};
          const VoxelBox bricks = node.intersection({low, {last.x + 1, last.y + 1, last.z + 1}});
          std::uint32_t& entry = node_of(node.min);
          if (bricks == node && (entry & OccupancyCodes::kUniform) != 0) {
            entry = uniform;
            continue;
          }
          for (std::int32_t x = bricks.min.x; x < bricks.max.x; ++x) {
            for (std::int32_t y = bricks.min.y; y < bricks.max.y; ++y) {
              for (std::int32_t z = bricks.min.z; z < bricks.max.z; ++z) {
                entry_of({x, y, z}) = uniform;
              }
            }
          }
        }
      }
    }
  }

 private:
  [[nodiscard]] Index3 brick_at(Index3 voxel) const {
    const Index3& first = table_.first_brick;
    return {(voxel.x >> 3) - first.x, (voxel.y >> 3) - first.y, (voxel.z >> 3) - first.z};
  }
  [[nodiscard]] std::uint32_t& node_of(Index3 brick) {
    const auto part = [](std::int32_t v) { return static_cast<std::size_t>(v >> 4); };
    return table_
        .node_entries[(part(brick.x) * static_cast<std::size_t>(table_.nodes[1]) + part(brick.y)) *
                          static_cast<std::size_t>(table_.nodes[2]) +
                      part(brick.z)];
  }
  // In a node with entries of its own.
  [[nodiscard]] std::uint32_t& entry_of(Index3 brick) {
    std::uint32_t& node = node_of(brick);
    if ((node & OccupancyCodes::kUniform) != 0) {
      const std::uint32_t before = node;
      check_capacity(table_.entries.size() + kEntriesPerNode);
      node = static_cast<std::uint32_t>(table_.entries.size());
      table_.entries.resize(table_.entries.size() + kEntriesPerNode, before);
    }
    return table_.entries[node + brick_in_node(brick)];
  }

  OccupancyCodes& table_;
};

}  // namespace

OccupancyCodes::OccupancyCodes(const BeliefGrid& grid)
    : min_index(grid.min_index()),
      dims(grid.dims()),
      first_brick{min_index.x >> 3, min_index.y >> 3, min_index.z >> 3} {
  const std::array<std::int32_t, 3> low{min_index.x, min_index.y, min_index.z},
      size{dims.x, dims.y, dims.z};
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t end = std::int64_t{low[a] & 7} + size[a];
    nodes[a] = static_cast<std::int32_t>((end + kNodeSize - 1) / kNodeSize);
    count *= static_cast<std::size_t>(nodes[a]);
    if (count > kMostNodes) {
      throw Error(ErrorCode::capacity,
                  "the workspace has more than " + std::to_string(kMostNodes) +
                      " cubes of 128 voxels: too many for a table of its log-odds");
    }
  }
  node_entries.assign(count, kUniform | kUnknown);
  Filler filler(*this);
  visit_grid(
      grid, [&](Index3 origin, const std::uint8_t* block) { filler.put(origin, block); },
      [&](Index3 origin, std::int32_t edge, std::uint8_t code) {
        filler.fill(origin, edge, code);
      });
}

std::uint8_t OccupancyCodes::code(Index3 voxel) const {
  if (!VoxelBox::from_dims(min_index, dims).contains(voxel)) return kUnknown;
  const Index3 brick{(voxel.x >> 3) - first_brick.x, (voxel.y >> 3) - first_brick.y,
                     (voxel.z >> 3) - first_brick.z};
  const auto part = [](std::int32_t v) { return static_cast<std::size_t>(v >> 4); };
  const std::uint32_t node =
      node_entries[(part(brick.x) * static_cast<std::size_t>(nodes[1]) + part(brick.y)) *
                       static_cast<std::size_t>(nodes[2]) +
                   part(brick.z)];
  if ((node & kUniform) != 0) return static_cast<std::uint8_t>(node & 0xFFU);
  const std::uint32_t entry = entries[node + brick_in_node(brick)];
  if ((entry & kUniform) != 0) return static_cast<std::uint8_t>(entry & 0xFFU);
  return codes[entry + block_offset(voxel)];
}

float OccupancyCodes::log_odds(std::uint8_t code) { return code_log_odds(code); }
bool OccupancyCodes::is_occupied(std::uint8_t code) { return detail::is_occupied(code); }

}  // namespace viewgain
