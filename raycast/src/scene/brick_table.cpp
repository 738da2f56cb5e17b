// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "brick_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace viewgain::detail {
namespace {

constexpr std::size_t kStatesPerLeaf = 64;  // words for 2³ voxels each
// A brick is initially free.
constexpr std::uint32_t kFreeBrick = BrickTable::kFree << 30U | BrickIndex::kBrick;
constexpr std::uint32_t kFreeNode = BrickTable::kFree << 30U | BrickIndex::kNode;
constexpr std::uint32_t kFarBrick = BrickTable::kUnknown << 30U | BrickTable::kFarSlot;

// Number of a voxel's cube of 2³ voxels in its brick.
std::size_t cube_in_brick(std::int32_t x, std::int32_t y, std::int32_t z) {
  return static_cast<std::size_t>((x & 7) >> 1 << 4 | (y & 7) >> 1 << 2 | (z & 7) >> 1);
}

// Normals are stored with 10 bits each for x, y, z, from -511 to 511.
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
    table_.rate_shift = hazard_.cell_shift();
    cells_ = BrickIndex::kBrick >> table_.rate_shift;
    (void)add_far_slot();
    for (const GridSnapshot::Leaf& leaf : snapshot_.leaves) add_leaf(leaf);
    for (const VoxelBox& tile : snapshot_.tiles) add_unknown(tile);
    table_.for_each_own_node(widen_free);
    find_normals();
  }

 private:
  [[nodiscard]] Index3 on_lattice(Index3 at) const {
    return {at.x + table_.base.x, at.y + table_.base.y, at.z + table_.base.z};
  }

  // Makes a slot for a brick's rates.
  std::uint32_t add_slot(Index3 origin) {
    const float V = static_cast<float>(hazard_.voxel_size());
    const std::uint32_t slot = slots_++;
    const auto cells = static_cast<std::size_t>(cells_ * cells_ * cells_);
    BrickIndex::check_capacity(std::size_t{slots_} * std::max<std::size_t>(cells, kStatesPerLeaf));
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

  // Whether a cube has the far rate everywhere, and surface in it counts as new.
  [[nodiscard]] bool is_far(Index3 origin, int edge) const {
    const VoxelBox box{origin, {origin.x + edge, origin.y + edge, origin.z + edge}};
    const HazardConfig::Volume* volume = hazard_.volume();
    return box.intersection(hazard_.near_box()).volume() == 0 &&
           (volume == nullptr || box.intersection(volume->box).volume() == 0);
  }

  void add_leaf(const GridSnapshot::Leaf& leaf) {
    const std::uint32_t slot = add_slot(leaf.origin);
    const Index3 at = table_.in_table(leaf.origin);
    table_.own_entry(at.x, at.y, at.z) = BrickTable::kMixed << 30U | slot;
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

  // Adds a box of unknown voxels. Bricks cut by the workspace count as whole, because no ray goes
  // outside.
  void add_unknown(const VoxelBox& box) {
    const auto is_far_at = [&](Index3 at, int edge) { return is_far(on_lattice(at), edge); };
    table_.put(
        {table_.in_table(box.min), table_.in_table(box.max)},
        [&](Index3 node) {
          return is_far_at(node, BrickIndex::kNode) ? std::optional(kFarBrick) : std::nullopt;
        },
        [&](Index3 brick) {
          return BrickTable::kUnknown << 30U |
                 (is_far_at(brick, BrickIndex::kBrick) ? BrickTable::kFarSlot
                                                       : add_slot(on_lattice(brick)));
        });
  }

  // Number of free minus unknown voxels in the cube of 2³ with this lowest voxel, in table
  // coordinates. Voxels outside the workspace count as neither.
  [[nodiscard]] int balance(Index3 lowest) const {
    const VoxelBox box = VoxelBox::from_dims(lowest, {2, 2, 2}).intersection(table_.workspace());
    if (box.volume() == 0) return 0;
    const auto [x, y, z] = box.min;
    const std::uint32_t entry = table_.entries[table_.entry_index(x, y, z)];
    const auto all = static_cast<int>(box.volume());
    if (entry >> 30U == BrickTable::kFree) return all;
    if (entry >> 30U == BrickTable::kUnknown) return -all;
    const std::uint32_t states =
        table_.states[(entry & BrickTable::kPayload) * 64 + cube_in_brick(x, y, z)] & 0xFFFFU;
    const int unknown = std::popcount(states & BrickTable::kAllUnknown);
    return all - std::popcount(states & 0xAAAAU) - 2 * unknown;
  }

  // The normal at a cube points from the unknown to the free voxels around it.
  void find_normals() {
    table_.normals.assign(table_.states.size(), 0);
    for (const GridSnapshot::Leaf& leaf : snapshot_.leaves) {
      if (leaf.occupied == LeafMask{}) continue;
      const auto [x, y, z] = table_.in_table(leaf.origin);
      const std::size_t first =
          std::size_t{table_.entries[table_.entry_index(x, y, z)] & BrickTable::kPayload} * 64;
      // balance() of the leaf's cubes and of those around the leaf.
      std::array<int, 216> around{};
      for (int i = 0; i < 216; ++i) {
        around[static_cast<std::size_t>(i)] =
            balance({x + 2 * (i / 36 - 1), y + 2 * (i / 6 % 6 - 1), z + 2 * (i % 6 - 1)});
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

  // Stores in each free brick of a node the size of the largest aligned free cube around it.
  static void widen_free(std::uint32_t* entries) {
    std::replace(entries, entries + BrickIndex::kEntries, kFreeNode, kFreeBrick);
    widen_cubes(
        16, 16,
        [&](unsigned x, unsigned y, unsigned z) -> std::uint32_t& {
          return entries[x << 8U | y << 4U | z];
        },
        [](std::uint32_t entry, unsigned edge) {
          return entry == edge / 2 * BrickIndex::kBrick ? std::optional(2 * entry) : std::nullopt;
        });
  }

  const GridSnapshot& snapshot_;
  const HazardField& hazard_;
  BrickTable& table_;
  int cells_ = 0;  // hazard cells along a brick's edge
  std::uint32_t slots_ = 0;
};

Eigen::Vector3f BrickTable::normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const std::uint32_t entry = entries[entry_index(x, y, z)];
  return unpack_normal(normals[std::size_t{entry & kPayload} * 64 + cube_in_brick(x, y, z)]);
}

BrickTable::BrickTable(const GridSnapshot& snapshot, const HazardField& hazard)
    : BrickIndex(snapshot.min_index, snapshot.dims, kFreeNode),
      pooling_length(hazard.pooling().length / snapshot.voxel_size) {
  BrickTableMaker(snapshot, hazard, *this).run();
}

}  // namespace viewgain::detail
