// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "brick_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "viewgain/support/block_lattice.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kCubes = 64;  // of 2³ voxels in a brick
// A brick is free at first, or has the far rate throughout.
constexpr std::uint32_t kFreeBrick = BrickTable::kFree << 30U | BrickIndex::kBrick;
constexpr std::uint32_t kFreeNode = BrickTable::kFree << 30U | BrickIndex::kNode;
constexpr std::uint32_t kFarBrick = BrickTable::kUnknown << 30U;

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

using Cubes = std::array<std::uint32_t, kCubes>;  // the states of a brick's voxels

// The edge that a cube of unknown voxels with one rate may have: so small that it matters little
// where in it a ray ends.
std::uint32_t largest_cell(float rate, unsigned shift) {
  constexpr float kMostDepth = 0.005F;  // of a ray along the edge
  std::uint32_t edge = BrickIndex::kBrick;
  while (edge > 1U << shift && !(std::abs(rate) * static_cast<float>(edge) <= kMostDepth)) {
    edge /= 2;
  }
  return edge;
}

// What BrickTable::records has of a brick. Voxels by x << 6 | y << 3 | z: an octal digit each.
class BrickRecords {
 public:
  static constexpr unsigned kVoxels = 512;

  BrickRecords(const HazardField& hazard, Index3 origin, const Cubes& cubes)
      : shift_(static_cast<unsigned>(hazard.cell_shift())) {
    for (unsigned i = 0; i < kVoxels; ++i) {
      const unsigned bit = ((i >> 6U & 1U) << 2U | (i >> 3U & 1U) << 1U | (i & 1U)) * 2U;
      voxels_[i].state = cubes[cube_of(i)] >> bit & 3U;
    }
    find_rates(hazard, origin);
    widen_cubes(
        8, 8,
        [&](unsigned x, unsigned y, unsigned z) -> Voxel& {
          return voxels_[x << 6U | y << 3U | z];
        },
        [this](Voxel voxel, unsigned edge) {
          const bool may_grow = 2 * voxel.edge == edge &&
                                voxel.state != BrickTable::kOccupiedVoxel &&
                                edge <= largest_cell(voxel.rate, shift_);
          voxel.edge = edge;
          return may_grow ? std::optional(voxel) : std::nullopt;
        });
  }

  void append_to(const Cubes& cubes, bool by_cell, std::vector<std::uint32_t>& records) const {
    const unsigned shift = by_cell ? shift_ : std::min(shift_, 1U);
    const unsigned within = ((1U << shift) - 1U) * 0111U;
    for (unsigned i = 0; i < kVoxels; ++i) {
      if ((i & within) != 0) continue;
      const Voxel& voxel = voxels_[i];
      if (shift_ == 0) {
        append_voxel(voxel.state, voxel.edge, voxel.rate, records);
      } else {
        append_cube(cubes[cube_of(i)], voxel.edge, rate_of_cube(i), records);
      }
    }
  }
  static void append_voxel(std::uint32_t state, std::uint32_t edge, float rate,
                           std::vector<std::uint32_t>& records) {
    records.push_back(rounded(rate) | (edge - 1) << 2U | state);
  }
  static void append_cube(std::uint32_t states, std::uint32_t edge, float rate,
                          std::vector<std::uint32_t>& records) {
    records.push_back(states | edge << BrickTable::kEdgeShift);
    records.push_back(std::bit_cast<std::uint32_t>(rate));
  }

 private:
  struct Voxel {
    std::uint32_t state = 0, edge = 1;
    float rate = 0;  // of unknown voxels
    bool operator==(const Voxel& other) const {
      return state == other.state && edge == other.edge &&
             std::bit_cast<std::uint32_t>(rate) == std::bit_cast<std::uint32_t>(other.rate);
    }
  };

  static unsigned cube_of(unsigned voxel) {
    return (voxel >> 7U & 3U) << 4U | (voxel >> 4U & 3U) << 2U | (voxel >> 1U & 3U);
  }

  // Rounded to the nearest number that leaves room for edge and state; the sign stays.
  static std::uint32_t rounded(float rate) {
    constexpr std::uint32_t kRest = BrickTable::kStateBits | BrickTable::kTopBits;
    constexpr std::uint32_t kHalf = (kRest + 1) / 2, kLargest = 0x7F7FFFFF;  // finite
    const auto bits = std::bit_cast<std::uint32_t>(rate);
    return ((bits & 0x7FFFFFFFU) < kLargest - kHalf ? bits + kHalf : bits) & ~kRest;
  }

  void find_rates(const HazardField& hazard, Index3 origin) {
    const auto V = static_cast<float>(hazard.voxel_size());
    const unsigned within = ((1U << shift_) - 1U) * 0111U;  // of a cell
    std::array<float, kVoxels> rates{};
    for (unsigned i = 0; i < kVoxels; ++i) {
      if ((i & within) == 0) {
        const Index3 at{origin.x + static_cast<int>(i >> 6U),
                        origin.y + static_cast<int>(i >> 3U & 7U),
                        origin.z + static_cast<int>(i & 7U)};
        const float rate = hazard.rate(at) * V;
        rates[i] = hazard.is_new(at) ? rate : std::copysign(rate, -1.0F);
      }
      if (voxels_[i].state == BrickTable::kUnknownVoxel) voxels_[i].rate = rates[i & ~within];
    }
  }
  // The unknown voxels of a cube of 2³ share a rate.
  [[nodiscard]] float rate_of_cube(unsigned first) const {
    for (const unsigned other : {0U, 1U, 010U, 011U, 0100U, 0101U, 0110U, 0111U}) {
      const Voxel& voxel = voxels_[first | other];
      if (voxel.state == BrickTable::kUnknownVoxel) return voxel.rate;
    }
    return 0;
  }

  unsigned shift_;
  std::array<Voxel, kVoxels> voxels_{};
};

}  // namespace

class BrickTableMaker {
 public:
  BrickTableMaker(const GridSnapshot& snapshot, const HazardField& hazard, BrickTable& table)
      : snapshot_(snapshot), hazard_(hazard), table_(table) {}

  void run() {
    table_.rate_shift = hazard_.cell_shift();
    add_far();
    for (const GridSnapshot::Leaf& leaf : snapshot_.leaves) add_leaf(leaf);
    table_.normals.assign(cubes_.size(), 0);
    for (const VoxelBox& tile : snapshot_.tiles) add_unknown(tile);
    table_.for_each_own_node(widen_free);
    find_normals();
  }

 private:
  [[nodiscard]] Index3 on_lattice(Index3 at) const {
    return {at.x + table_.base.x, at.y + table_.base.y, at.z + table_.base.z};
  }

  // Has a cube the far rate everywhere, and is what is found in it new?
  [[nodiscard]] bool is_far(Index3 origin, int edge) const {
    const VoxelBox box{origin, {origin.x + edge, origin.y + edge, origin.z + edge}};
    const HazardConfig::Volume* volume = hazard_.volume();
    return box.intersection(hazard_.near_box()).volume() == 0 &&
           (volume == nullptr || box.intersection(volume->box).volume() == 0);
  }

  void add_leaf(const GridSnapshot::Leaf& leaf) {
    Cubes cubes{};
    const auto put = [&](const LeafMask& mask, std::uint32_t state) {
      for_each_bit(mask, [&](unsigned offset) {
        const unsigned x = offset >> 6U, y = offset >> 3U & 7U, z = offset & 7U;
        const unsigned bit = ((x & 1U) << 2U | (y & 1U) << 1U | (z & 1U)) * 2U;
        cubes[(x >> 1U) << 4U | (y >> 1U) << 2U | z >> 1U] |= state << bit;
      });
    };
    LeafMask unknown = leaf.non_free;
    for (std::size_t i = 0; i < 8; ++i) unknown[i] &= ~leaf.occupied[i];
    put(unknown, BrickTable::kUnknownVoxel);
    put(leaf.occupied, BrickTable::kOccupiedVoxel);
    cubes_.insert(cubes_.end(), cubes.begin(), cubes.end());
    // Outside the workspace, where no ray goes, counts as unknown, as in bricks without a leaf.
    const LeafMask inside = block_mask(workspace_, leaf.origin);
    LeafMask outside{};
    for (std::size_t i = 0; i < 8; ++i) outside[i] = ~inside[i];
    put(outside, BrickTable::kUnknownVoxel);
    const Index3 at = table_.in_table(leaf.origin);
    table_.own_entry(at.x, at.y, at.z) =
        add_brick(BrickTable::kMixed, BrickRecords(hazard_, leaf.origin, cubes), cubes);
  }

  // The records of bricks with the far rate: as many as those of a mixed brick.
  void add_far() {
    cubes_.assign(kCubes, 0);
    const float rate = hazard_.far_rate() * static_cast<float>(hazard_.voxel_size());
    const std::uint32_t edge = largest_cell(rate, static_cast<unsigned>(table_.rate_shift));
    if (table_.rate_shift == 0) {
      for (unsigned i = 0; i < BrickRecords::kVoxels; ++i) {
        BrickRecords::append_voxel(BrickTable::kUnknownVoxel, edge, rate, table_.records);
      }
    } else {
      for (unsigned i = 0; i < kCubes; ++i) {
        BrickRecords::append_cube(BrickTable::kAllUnknown, edge, rate, table_.records);
      }
    }
  }

  // The entry of a brick with records of its own.
  std::uint32_t add_brick(std::uint32_t kind, const BrickRecords& brick, const Cubes& cubes) {
    const std::size_t first = table_.places();
    BrickIndex::check_capacity(2 * (first + BrickRecords::kVoxels));  // two bits are the kind's
    brick.append_to(cubes, kind == BrickTable::kUnknown, table_.records);
    return kind << 30U | static_cast<std::uint32_t>(first);
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
          if (is_far_at(brick, BrickIndex::kBrick)) return kFarBrick;
          return add_brick(BrickTable::kUnknown,
                           BrickRecords(hazard_, on_lattice(brick), all_unknown_), all_unknown_);
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
    const std::uint32_t states = cubes_[table_.slot_of(entry) * kCubes + cube_in_brick(x, y, z)];
    const int unknown = std::popcount(states & BrickTable::kAllUnknown);
    return all - std::popcount(states & 0xAAAAU) - 2 * unknown;
  }

  // The normal at a cube points from the unknown to the free voxels around it.
  void find_normals() {
    for (const GridSnapshot::Leaf& leaf : snapshot_.leaves) {
      if (leaf.occupied == LeafMask{}) continue;
      const auto [x, y, z] = table_.in_table(leaf.origin);
      const std::size_t first =
          table_.slot_of(table_.entries[table_.entry_index(x, y, z)]) * kCubes;
      // The balances of the leaf's cubes and of those around it.
      std::array<int, 216> around{};
      for (int i = 0; i < 216; ++i) {
        around[static_cast<std::size_t>(i)] =
            balance({x + 2 * (i / 36 - 1), y + 2 * (i / 6 % 6 - 1), z + 2 * (i % 6 - 1)});
      }
      for (std::size_t cube = 0; cube < kCubes; ++cube) {
        if ((cubes_[first + cube] & 0xAAAAU) == 0) continue;
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
  const VoxelBox workspace_ = VoxelBox::from_dims(snapshot_.min_index, snapshot_.dims);
  std::vector<std::uint32_t> cubes_;  // eight states each, kCubes a slot
  const Cubes all_unknown_ = [] {
    Cubes cubes{};
    cubes.fill(BrickTable::kAllUnknown);
    return cubes;
  }();
};

Eigen::Vector3f BrickTable::normal_at(std::int32_t x, std::int32_t y, std::int32_t z) const {
  const std::size_t slot = slot_of(entries[entry_index(x, y, z)]);
  return unpack_normal(normals[slot * kCubes + cube_in_brick(x, y, z)]);
}

BrickTable::BrickTable(const GridSnapshot& snapshot, const HazardField& hazard)
    : BrickIndex(snapshot.min_index, snapshot.dims, kFreeNode),
      pooling_length(hazard.pooling().length / snapshot.voxel_size) {
  BrickTableMaker(snapshot, hazard, *this).run();
}

}  // namespace viewgain::detail
