// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "brick_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {
namespace {

constexpr int kBrick = 8, kNode = 128, kBricksPerNode = kNode / kBrick;
constexpr std::uint32_t kEntriesPerNode = kBricksPerNode * kBricksPerNode * kBricksPerNode;
// Nodes without entries of their own share these.
constexpr std::uint32_t kFreeNode = 0, kFarNode = kEntriesPerNode;
constexpr std::size_t kStatesPerLeaf = 64;  // words, of 2³ voxels each
constexpr std::size_t kMostNodes = std::size_t{1} << 24U;

constexpr std::uint32_t kFreeBrick = BrickTable::kFree << 30U | kBrick;
constexpr std::uint32_t kFarBrick = BrickTable::kUnknown << 30U | BrickTable::kFarSlot;

std::uint32_t place_in_node(Index3 brick) {
  return static_cast<std::uint32_t>((brick.x & 15) << 8 | (brick.y & 15) << 4 | (brick.z & 15));
}

// Number of the cube of 2³ of a voxel in its brick.
std::size_t cube_in_brick(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::size_t>((x & 7) >> 1 << 4 | (y & 7) >> 1 << 2 | (z & 7) >> 1);
}

// Normals are kept in tenths of a percent or so: 10 bits each for x, y, z, from -511 to 511.
std::uint32_t pack_normal(const Eigen::Vector3f& n) {
  const auto part = [](float v) {
    return static_cast<std::uint32_t>(std::lround(v * 511.0F) & 1023);
  };
  return part(n.x()) << 20U | part(n.y()) << 10U | part(n.z());
}
Eigen::Vector3f unpack_normal(std::uint32_t bits) {
  const auto part = [&](unsigned shift) {
    const auto value = static_cast<std::int32_t>(bits >> shift & 1023U);
    return static_cast<float>(value >= 512 ? value - 1024 : value) / 511.0F;
  };
  return {part(20), part(10), part(0)};
}

}  // namespace

class BrickTableMaker {
 public:
  BrickTableMaker(const GridSnapshot& snapshot, const HazardField& hazard, BrickTable& table)
      : snapshot_(snapshot), hazard_(hazard), table_(table) {}

  void run() {
    lay_out();
    table_.entries.assign(kEntriesPerNode, BrickTable::kFree << 30U | kNode);
    table_.entries.resize(2 * kEntriesPerNode, kFarBrick);
    table_.rates.clear();
    (void)add_far_slot();
    for (const SnapshotLeaf& leaf : snapshot_.leaves) add_leaf(leaf);
    for (const VoxelBox& tile : snapshot_.tiles) add_unknown(tile);
    for (std::size_t node = kFarNode + kEntriesPerNode; node < table_.entries.size();
         node += kEntriesPerNode) {
      widen_free(&table_.entries[node]);
    }
    find_normals();
  }

 private:
  void lay_out() {
    const Index3& base = snapshot_.min_index;
    const Index3& dims = snapshot_.dims;
    const std::array<std::int32_t, 3> low{base.x, base.y, base.z}, size{dims.x, dims.y, dims.z};
    std::size_t count = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      table_.offset[a] = low[a] & (kBrick - 1);
      const std::int64_t end = std::int64_t{table_.offset[a]} + size[a];
      table_.nodes[a] = static_cast<std::int32_t>((end + kNode - 1) / kNode);
      count *= static_cast<std::size_t>(table_.nodes[a]);
      if (count > kMostNodes) {
        throw Error(ErrorCode::capacity, "the workspace has more than " +
                                             std::to_string(kMostNodes) +
                                             " cubes of 128 voxels: too many for a surface gain");
      }
    }
    first_brick_ = {base.x >> 3, base.y >> 3, base.z >> 3};
    table_.node_entries.assign(count, kFreeNode);
    table_.rate_shift = hazard_.cell_shift();
    cells_ = kBrick >> table_.rate_shift;
  }

  // Bricks by their numbers from the workspace's first on.
  [[nodiscard]] std::uint32_t& node_of(Index3 brick) {
    const auto x = static_cast<std::size_t>(brick.x >> 4),
               y = static_cast<std::size_t>(brick.y >> 4),
               z = static_cast<std::size_t>(brick.z >> 4);
    return table_.node_entries[(x * static_cast<std::size_t>(table_.nodes[1]) + y) *
                                   static_cast<std::size_t>(table_.nodes[2]) +
                               z];
  }
  [[nodiscard]] Index3 brick_at(Index3 voxel) const {
    return {(voxel.x >> 3) - first_brick_.x, (voxel.y >> 3) - first_brick_.y,
            (voxel.z >> 3) - first_brick_.z};
  }
  [[nodiscard]] Index3 origin_of(Index3 brick) const {
    return {(brick.x + first_brick_.x) * kBrick, (brick.y + first_brick_.y) * kBrick,
            (brick.z + first_brick_.z) * kBrick};
  }

  // The entry of a brick, in a node with entries of its own.
  [[nodiscard]] std::uint32_t& entry_of(Index3 brick) {
    std::uint32_t& node = node_of(brick);
    if (node <= kFarNode) {
      const std::uint32_t fill = node == kFarNode ? kFarBrick : kFreeBrick;
      node = static_cast<std::uint32_t>(table_.entries.size());
      check_capacity(table_.entries.size() + kEntriesPerNode);
      table_.entries.resize(table_.entries.size() + kEntriesPerNode, fill);
    }
    return table_.entries[node + place_in_node(brick)];
  }

  // Rates for a brick in a slot of its own.
  std::uint32_t add_slot(Index3 origin) {
    const float V = static_cast<float>(hazard_.voxel_size());
    const std::uint32_t slot = slots_++;
    const auto cells = static_cast<std::size_t>(cells_ * cells_ * cells_);
    check_capacity(std::size_t{slots_} * std::max<std::size_t>(cells, kStatesPerLeaf));
    const int shift = table_.rate_shift;
    for (int x = 0; x < cells_; ++x) {
      for (int y = 0; y < cells_; ++y) {
        for (int z = 0; z < cells_; ++z) {
          const Index3 voxel{origin.x + (x << shift), origin.y + (y << shift),
                             origin.z + (z << shift)};
          const float rate = hazard_.rate(voxel) * V;
          table_.rates.push_back(hazard_.is_new(voxel) ? rate : std::copysign(rate, -1.0F));
        }
      }
    }
    return slot;
  }

  std::uint32_t add_far_slot() {
    const float V = static_cast<float>(hazard_.voxel_size());
    const float rate = hazard_.far_rate();
    table_.rates.assign(static_cast<std::size_t>(cells_ * cells_ * cells_), rate * V);
    table_.states.assign(kStatesPerLeaf, 0);
    return slots_++;
  }

  // Has a cube the far rate everywhere, and is what is found in it new?
  [[nodiscard]] bool is_far(Index3 origin, int edge) const {
    const VoxelBox box{origin, {origin.x + edge, origin.y + edge, origin.z + edge}};
    const HazardVolume* volume = hazard_.volume();
    return box.intersection(hazard_.near_box()).volume() == 0 &&
           (volume == nullptr || box.intersection(volume->box).volume() == 0);
  }

  // Gathers have indices of 32 bits with a sign.
  static void check_capacity(std::size_t size) {
    if (size > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
      throw Error(ErrorCode::capacity, "the map is too large for a surface gain");
    }
  }

  void add_leaf(const SnapshotLeaf& leaf) {
    const std::uint32_t slot = add_slot(leaf.origin);
    entry_of(brick_at(leaf.origin)) = BrickTable::kMixed << 30U | slot;
    std::array<std::uint32_t, kStatesPerLeaf> cubes{};
    const auto put = [&](const LeafMask& mask, std::uint32_t state) {
      for_each_bit(mask, [&](unsigned offset) {
        const unsigned x = offset >> 6U, y = offset >> 3U & 7U, z = offset & 7U;
        const unsigned cube = (x >> 1U) << 4U | (y >> 1U) << 2U | z >> 1U;
        const unsigned bit = ((x & 1U) << 2U | (y & 1U) << 1U | (z & 1U)) * 2U;
        cubes[cube] |= state << bit;
      });
    };
    LeafMask unknown = leaf.non_free;
    for (std::size_t i = 0; i < 8; ++i) unknown[i] &= ~leaf.occupied[i];
    put(unknown, BrickTable::kUnknownVoxel);
    put(leaf.occupied, BrickTable::kOccupiedVoxel);
    for (unsigned octant = 0; octant < 8; ++octant) {
      const unsigned first = (octant >> 2U) << 5U | (octant >> 1U & 1U) << 3U | (octant & 1U) << 1U;
      const std::array<unsigned, 8> parts{first,      first + 1,  first + 4,  first + 5,
                                          first + 16, first + 17, first + 20, first + 21};
      std::uint32_t any = 0, all = 0xFFFF;
      for (const unsigned part : parts) any |= cubes[part], all &= cubes[part];
      const bool is_same = any == all && (any == 0 || any == BrickTable::kAllUnknown);
      for (const unsigned part : parts) {
        const std::uint32_t cube = cubes[part];
        const std::uint32_t edge = is_same                                        ? 4
                                   : cube == 0 || cube == BrickTable::kAllUnknown ? 2
                                                                                  : 1;
        cubes[part] |= edge << 16U;
      }
    }
    table_.states.insert(table_.states.end(), cubes.begin(), cubes.end());
  }

  // A box of unknown voxels. Bricks that the workspace cuts count whole: no ray goes there.
  void add_unknown(const VoxelBox& box) {
    const Index3 last = brick_at({box.max.x - 1, box.max.y - 1, box.max.z - 1});
    const VoxelBox bricks{brick_at(box.min), {last.x + 1, last.y + 1, last.z + 1}};
    const VoxelBox nodes{
        {bricks.min.x >> 4, bricks.min.y >> 4, bricks.min.z >> 4},
        {(bricks.max.x + 15) >> 4, (bricks.max.y + 15) >> 4, (bricks.max.z + 15) >> 4}};
    const VoxelBox workspace = VoxelBox::from_dims(snapshot_.min_index, snapshot_.dims);
    for (std::int32_t nx = nodes.min.x; nx < nodes.max.x; ++nx) {
      for (std::int32_t ny = nodes.min.y; ny < nodes.max.y; ++ny) {
        for (std::int32_t nz = nodes.min.z; nz < nodes.max.z; ++nz) {
          const Index3 origin = origin_of({nx * 16, ny * 16, nz * 16});
          const VoxelBox node{origin, {origin.x + kNode, origin.y + kNode, origin.z + kNode}};
          const VoxelBox within = node.intersection(workspace);
          std::uint32_t& entries = node_of({nx * 16, ny * 16, nz * 16});
          if (entries <= kFarNode && within.intersection(box) == within && is_far(origin, kNode)) {
            entries = kFarNode;
          } else {
            add_bricks(bricks.intersection(
                {{nx * 16, ny * 16, nz * 16}, {nx * 16 + 16, ny * 16 + 16, nz * 16 + 16}}));
          }
        }
      }
    }
  }

  void add_bricks(const VoxelBox& bricks) {
    for (std::int32_t x = bricks.min.x; x < bricks.max.x; ++x) {
      for (std::int32_t y = bricks.min.y; y < bricks.max.y; ++y) {
        for (std::int32_t z = bricks.min.z; z < bricks.max.z; ++z) {
          const Index3 origin = origin_of({x, y, z});
          const std::uint32_t slot =
              is_far(origin, kBrick) ? BrickTable::kFarSlot : add_slot(origin);
          entry_of({x, y, z}) = BrickTable::kUnknown << 30U | slot;
        }
      }
    }
  }

  // Free less unknown voxels of a cube of 2³, by its number on the lattice of cubes. Voxels outside
  // the workspace count as neither.
  [[nodiscard]] int balance(Index3 cube) const {
    const Index3 voxel{cube.x * 2, cube.y * 2, cube.z * 2};
    const VoxelBox box = VoxelBox{voxel, {voxel.x + 2, voxel.y + 2, voxel.z + 2}}.intersection(
        VoxelBox::from_dims(snapshot_.min_index, snapshot_.dims));
    if (box.volume() == 0) return 0;
    const auto table = [&](std::int32_t v, std::int32_t base, std::size_t a) {
      return v - base + table_.offset[a];
    };
    const Index3& base = snapshot_.min_index;
    const std::int32_t x = table(box.min.x, base.x, 0), y = table(box.min.y, base.y, 1),
                       z = table(box.min.z, base.z, 2);
    const std::uint32_t entry = table_.entries[table_.entry_index(x, y, z)];
    const auto all = static_cast<int>(box.volume());
    if (entry >> 30U == BrickTable::kFree) return all;
    if (entry >> 30U == BrickTable::kUnknown) return -all;
    const std::uint32_t states =
        table_.states[(entry & BrickTable::kPayload) * 64 + cube_in_brick(x, y, z)] & 0xFFFFU;
    const int unknown = std::popcount(states & BrickTable::kAllUnknown);
    return all - std::popcount(states & 0xAAAAU) - 2 * unknown;
  }

  // The normal at a cube leads from where voxels around are unknown to where they are free.
  void find_normals() {
    table_.normals.assign(table_.states.size(), 0);
    for (const SnapshotLeaf& leaf : snapshot_.leaves) {
      if (leaf.occupied == LeafMask{}) continue;
      const Index3& base = snapshot_.min_index;
      const std::int32_t x = leaf.origin.x - base.x + table_.offset[0],
                         y = leaf.origin.y - base.y + table_.offset[1],
                         z = leaf.origin.z - base.z + table_.offset[2];
      const std::size_t first =
          std::size_t{table_.entries[table_.entry_index(x, y, z)] & BrickTable::kPayload} * 64;
      // The balances of the leaf's cubes and of those around it.
      std::array<int, 216> around{};
      for (int i = 0; i < 216; ++i) {
        around[static_cast<std::size_t>(i)] =
            balance({(leaf.origin.x >> 1) + i / 36 - 1, (leaf.origin.y >> 1) + i / 6 % 6 - 1,
                     (leaf.origin.z >> 1) + i % 6 - 1});
      }
      for (std::size_t cube = 0; cube < 64; ++cube) {
        if ((table_.states[first + cube] & 0xAAAAU) == 0) continue;
        const std::size_t middle =
            ((cube >> 4U) + 1) * 36 + ((cube >> 2U & 3U) + 1) * 6 + (cube & 3U) + 1;
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (int k = 0; k < 27; ++k) {
          const int dx = k / 9 - 1, dy = k / 3 % 3 - 1, dz = k % 3 - 1;
          const auto at =
              static_cast<std::size_t>(static_cast<int>(middle) + dx * 36 + dy * 6 + dz);
          sum += static_cast<float>(around[at]) * Eigen::Vector3i(dx, dy, dz).cast<float>();
        }
        const float norm = sum.norm();
        if (norm > 0) table_.normals[first + cube] = pack_normal(sum / norm);
      }
    }
  }

  // Tells each free brick of a node how large the aligned cube is that is free round it.
  static void widen_free(std::uint32_t* entries) {
    for (std::uint32_t edge = 2; edge <= kBricksPerNode; edge *= 2) {
      for (std::uint32_t at = 0; at < kEntriesPerNode; ++at) {
        const std::uint32_t x = at >> 8U, y = at >> 4U & 15U, z = at & 15U;
        if (((x | y | z) & (edge - 1)) != 0) continue;
        const auto for_cube = [&](auto&& visit) {
          for (std::uint32_t i = x; i < x + edge; ++i) {
            for (std::uint32_t j = y; j < y + edge; ++j) {
              for (std::uint32_t k = z; k < z + edge; ++k) visit(entries[i << 8U | j << 4U | k]);
            }
          }
        };
        bool free = true;
        for_cube([&](std::uint32_t entry) { free = free && entry == edge / 2 * kBrick; });
        if (free) for_cube([&](std::uint32_t& entry) { entry = edge * kBrick; });
      }
    }
  }

  const GridSnapshot& snapshot_;
  const HazardField& hazard_;
  BrickTable& table_;
  Index3 first_brick_{};
  int cells_ = 0;  // hazard cells along a brick's edge
  std::uint32_t slots_ = 0;
};

std::size_t BrickTable::entry_index(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const auto node = (static_cast<std::size_t>(x >> 7) * static_cast<std::size_t>(nodes[1]) +
                     static_cast<std::size_t>(y >> 7)) *
                        static_cast<std::size_t>(nodes[2]) +
                    static_cast<std::size_t>(z >> 7);
  return node_entries[node] + place_in_node({x >> 3, y >> 3, z >> 3});
}

Eigen::Vector3f BrickTable::normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const std::uint32_t entry = entries[entry_index(x, y, z)];
  return unpack_normal(normals[std::size_t{entry & kPayload} * 64 + cube_in_brick(x, y, z)]);
}

BrickTable::BrickTable(const GridSnapshot& snapshot, const HazardField& hazard)
    : pooling_length(hazard.pooling().length / snapshot.voxel_size) {
  BrickTableMaker(snapshot, hazard, *this).run();
}

}  // namespace viewgain::detail
