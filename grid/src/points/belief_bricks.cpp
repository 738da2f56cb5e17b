// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_bricks.hpp"

#include <algorithm>

namespace viewgain::detail {
namespace {

// Cubes of 2^shift voxels lie within ±2^27 of the origin, so 21 bits per axis do not suffice for
// all; within one workspace (at most 2^13 blocks per axis) the low 21 bits are unique.
std::uint64_t cube_number(Index3 voxel, unsigned shift) {
  const auto bits = [shift](std::int32_t v) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(v) >> shift & 0x1FFFFFU);
  };
  return bits(voxel.x) << 42U | bits(voxel.y) << 21U | bits(voxel.z);
}

std::uint64_t block_number(Index3 origin) { return cube_number(origin, 3); }

bool is_in_one_cube(const VoxelBox& tile, unsigned shift) {
  const auto same = [shift](std::int32_t from, std::int32_t to) {
    return from >> shift == (to - 1) >> shift;
  };
  return same(tile.min.x, tile.max.x) && same(tile.min.y, tile.max.y) &&
         same(tile.min.z, tile.max.z);
}

// For a row of 8 bits: the number of set bits and the sum of their positions. A table, because
// without -mpopcnt std::popcount is a function call.
struct RowSums {
  std::int8_t count = 0, places = 0;
};
constexpr std::array<RowSums, 256> kRowSums = [] {
  std::array<RowSums, 256> sums{};
  for (unsigned row = 0; row < 256; ++row) {
    for (int place = 0; place < 8; ++place) {
      if ((row >> place & 1U) == 0) continue;
      ++sums[row].count;
      sums[row].places = static_cast<std::int8_t>(sums[row].places + place);
    }
  }
  return sums;
}();

}  // namespace

BeliefBricks::BeliefBricks(const GridSnapshot& snapshot, const std::vector<BeliefBlockAt>& blocks,
                           int shift)
    : workspace_(VoxelBox::from_dims(snapshot.min_index, snapshot.dims)), shift_(shift) {
  for (const VoxelBox& tile : snapshot.tiles) {
    std::size_t size = 0;
    while (size + 1 < kTileShifts.size() && !is_in_one_cube(tile, kTileShifts[size])) ++size;
    unknown_cubes_[size].insert(cube_number(tile.min, kTileShifts[size]));
  }
  numbers_.reserve(snapshot.leaves.size() + blocks.size());
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) (void)brick_at(leaf.origin);
  for (const BeliefBlockAt& block : blocks) add_beliefs(block, snapshot.voxel_size);
  for (PlacedBelief& belief : beliefs_) {
    belief.covariance = belief.information.inverse();
    belief.mean = belief.covariance * belief.vector / std::ldexp(snapshot.voxel_size, shift_);
  }
  find_states(snapshot);
}

void BeliefBricks::add_beliefs(const BeliefBlockAt& block, double voxel_size) {
  const int scale = block.beliefs->scale;
  if (scale > shift_) return;
  Brick& brick = bricks_[brick_at(block.origin)];
  const int edge = 1 << shift_;
  const auto from_middle = [&](std::int32_t v) {
    return ((v & (edge - 1)) + 0.5 * ((1 << scale) - edge)) * voxel_size;
  };
  block.for_each([&](Index3 voxel, const Belief& belief) {
    if (belief.hits == 0) return;
    std::int32_t& at = brick.belief[block_offset(cell_of(voxel))];
    if (at == kNone) {
      at = static_cast<std::int32_t>(beliefs_.size());
      beliefs_.emplace_back();
    }
    // η about the cube's centre: readings are (voxel's centre - cube's centre) further away.
    PlacedBelief& sum = beliefs_[static_cast<std::size_t>(at)];
    const SymmetricMatrix3 information = belief.information_matrix();
    const auto& v = belief.information_vector;
    const Eigen::Vector3d d(from_middle(voxel.x), from_middle(voxel.y), from_middle(voxel.z));
    sum.information += information;
    sum.vector += Eigen::Vector3d(v[0], v[1], v[2]) + information * d;
    sum.hits += belief.hits;
  });
}

void BeliefBricks::find_states(const GridSnapshot& snapshot) {
  std::unordered_map<std::uint64_t, const GridSnapshot::Leaf*> leaves;
  leaves.reserve(snapshot.leaves.size());
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) leaves[block_number(leaf.origin)] = &leaf;
  const int edge = 1 << shift_;  // offset of a brick in leaves
  for (Brick& brick : bricks_) {
    LeafMask has_free{};
    for (int i = 0; i < edge * edge * edge; ++i) {
      const int x = i / (edge * edge), y = i / edge % edge, z = i % edge;
      const Index3 origin{(brick.origin.x << shift_) + kBlockSize * x,
                          (brick.origin.y << shift_) + kBlockSize * y,
                          (brick.origin.z << shift_) + kBlockSize * z};
      const auto found = leaves.find(block_number(origin));
      LeafMask free{};
      if (found != leaves.end()) {
        for (std::size_t w = 0; w < free.size(); ++w) free[w] = ~found->second->non_free[w];
        for_each_bit(found->second->occupied, [&](unsigned offset) {
          set_bit(brick.occupied, block_offset(cell_of(offset_voxel(origin, offset))));
        });
      } else if (!is_unknown_voxel(origin)) {
        free.fill(~std::uint64_t{0});
      }
      // Space beyond the workspace does not affect the direction of free space.
      const LeafMask inside = block_mask(workspace_, origin);
      for (std::size_t w = 0; w < free.size(); ++w) free[w] &= inside[w];
      for_each_bit(free, [&](unsigned offset) {
        set_bit(has_free, block_offset(cell_of(offset_voxel(origin, offset))));
      });
    }
    for (std::size_t w = 0; w < has_free.size(); ++w) {
      brick.non_free[w] = ~has_free[w] | brick.occupied[w];
    }
  }
}

std::size_t BeliefBricks::brick_at(Index3 leaf) {
  const Index3 cell = cell_of(leaf);
  const Index3 origin{cell.x & ~(kBlockSize - 1), cell.y & ~(kBlockSize - 1),
                      cell.z & ~(kBlockSize - 1)};
  const auto [found, is_new] =
      numbers_.try_emplace(block_number(origin), static_cast<std::int32_t>(bricks_.size()));
  if (is_new) {
    bricks_.emplace_back();
    bricks_.back().origin = origin;
    bricks_.back().belief.fill(kNone);
  }
  return static_cast<std::size_t>(found->second);
}

std::int32_t BeliefBricks::number(Index3 origin) const {
  const auto found = numbers_.find(block_number(origin));
  return found == numbers_.end() ? kNone : found->second;
}

bool BeliefBricks::is_unknown_tile(Index3 v) const {
  return is_unknown_voxel({v.x << shift_, v.y << shift_, v.z << shift_});
}

VoxelBox BeliefBricks::workspace_cells() const {
  const Index3& max = workspace_.max;
  const Index3 last = cell_of({max.x - 1, max.y - 1, max.z - 1});
  return {cell_of(workspace_.min), {last.x + 1, last.y + 1, last.z + 1}};
}

bool BeliefBricks::is_unknown_voxel(Index3 voxel) const {
  // A cube cut by the workspace's lower face starts outside of it.
  const Index3 v{std::max(voxel.x, workspace_.min.x), std::max(voxel.y, workspace_.min.y),
                 std::max(voxel.z, workspace_.min.z)};
  for (std::size_t size = 0; size < kTileShifts.size(); ++size) {
    if (unknown_cubes_[size].contains(cube_number(v, kTileShifts[size]))) return true;
  }
  return false;
}

void BeliefBricks::find_sides(ThreadPool& pool) {
  pool.for_each_chunk(bricks_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t brick = begin; brick < end; ++brick) {
      const BrickNeighborhood around(*this, brick);
      for (unsigned offset = 0; offset < kBlockVoxels; ++offset) {
        const std::int32_t i = bricks_[brick].belief[offset];
        if (i == kNone) continue;
        const Index3 v = offset_voxel(bricks_[brick].origin, offset);
        beliefs_[static_cast<std::size_t>(i)].toward_free =
            around.free_side(Eigen::Vector3d(v.x, v.y, v.z).array() + 0.5);
      }
    }
  });
}

std::vector<std::pair<std::size_t, unsigned>> BeliefBricks::occupied_with_belief() const {
  std::vector<std::pair<std::size_t, unsigned>> result;
  for (std::size_t brick = 0; brick < bricks_.size(); ++brick) {
    for_each_bit(bricks_[brick].occupied, [&](unsigned offset) {
      if (bricks_[brick].belief[offset] != kNone) result.emplace_back(brick, offset);
    });
  }
  return result;
}

BrickNeighborhood::BrickNeighborhood(const BeliefBricks& bricks, Index3 origin) : bricks_(&bricks) {
  low_ = {(origin.x >> 3) - 1, (origin.y >> 3) - 1, (origin.z >> 3) - 1};
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 3; ++z) {
        numbers_[static_cast<std::size_t>(9 * x + 3 * y + z)] =
            bricks.number({(low_.x + x) * 8, (low_.y + y) * 8, (low_.z + z) * 8});
      }
    }
  }
}

Eigen::Vector3d BrickNeighborhood::free_side(const Eigen::Vector3d& position) const {
  constexpr int kRadius = 3;
  const Index3 voxel = containing(position);
  const VoxelBox near = VoxelBox{
      {voxel.x - kRadius, voxel.y - kRadius, voxel.z - kRadius},
      {voxel.x + kRadius + 1, voxel.y + kRadius + 1,
       voxel.z + kRadius +
           1}}.intersection(bricks_->workspace_cells());
  const auto end_of = [](std::int32_t v, std::int32_t max) { return std::min(max, (v | 7) + 1); };
  Index3 sum{0, 0, 0};
  // Layer by layer of each block.
  for (std::int32_t x = near.min.x; x < near.max.x; ++x) {
    for (std::int32_t y0 = near.min.y; y0 < near.max.y; y0 = end_of(y0, near.max.y)) {
      for (std::int32_t z0 = near.min.z; z0 < near.max.z; z0 = end_of(z0, near.max.z)) {
        const Layer layer = layer_from({x, y0, z0});
        const auto count = static_cast<unsigned>(end_of(z0, near.max.z) - z0);
        const std::uint64_t bits = ((1U << count) - 1U) << static_cast<unsigned>(z0 & 7);
        for (std::int32_t y = y0; y < end_of(y0, near.max.y); ++y) {
          const auto row = static_cast<unsigned>(y & 7) << 3U;
          const RowSums& free = kRowSums[layer.free >> row & bits];
          const RowSums& unknown = kRowSums[layer.unknown >> row & bits];
          const int more_free = free.count - unknown.count;
          sum.x += (x - voxel.x) * more_free;
          sum.y += (y - voxel.y) * more_free;
          sum.z += ((z0 & ~7) - voxel.z) * more_free + free.places - unknown.places;
        }
      }
    }
  }
  return {static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z)};
}

BrickNeighborhood::Layer BrickNeighborhood::layer_from(Index3 v) const {
  const std::int32_t brick = brick_of(v);
  if (brick != BeliefBricks::kNone) {
    const auto x = static_cast<std::size_t>(v.x & 7);
    const std::uint64_t non_free = bricks_->non_free(static_cast<std::size_t>(brick))[x];
    const std::uint64_t occupied = bricks_->occupied(static_cast<std::size_t>(brick))[x];
    return {~non_free, non_free & ~occupied};
  }
  Layer layer;
  for (std::int32_t y = v.y; y <= (v.y | 7); ++y) {
    const std::uint64_t row = std::uint64_t{255} << (static_cast<unsigned>(y & 7) << 3U);
    (bricks_->is_unknown_tile({v.x, y, v.z}) ? layer.unknown : layer.free) |= row;
  }
  return layer;
}

}  // namespace viewgain::detail
