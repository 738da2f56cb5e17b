// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "belief_bricks.hpp"

namespace viewgain::detail {
namespace {

// Cubes of 2^shift voxels lie within +-2^27 of the origin, so 21 bits an axis would not do for all
// of them; within one workspace (at most 2^13 blocks an axis) the low 21 bits tell them apart.
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

}  // namespace

BeliefBricks::BeliefBricks(const BeliefGrid& grid)
    : workspace_(VoxelBox::from_dims(grid.min_index(), grid.dims())) {
  const GridSnapshot snapshot = grid.snapshot();
  const std::vector<BeliefBlockAt> blocks = grid.belief_blocks();
  numbers_.reserve(snapshot.leaves.size() + blocks.size());
  for (const SnapshotLeaf& leaf : snapshot.leaves) {
    Brick& brick = bricks_[brick_at(leaf.origin)];
    brick.non_free = leaf.non_free;
    brick.occupied = leaf.occupied;
  }
  for (const BeliefBlockAt& block : blocks) {
    Brick& brick = bricks_[brick_at(block.origin)];
    std::size_t i = 0;
    for_each_bit(block.beliefs->mask, [&](unsigned offset) {
      const Belief& belief = block.beliefs->beliefs[i++];
      if (belief.hits == 0) return;
      brick.belief[offset] = static_cast<std::int32_t>(beliefs_.size());
      const auto& v = belief.information_vector;
      beliefs_.push_back(
          {belief.information_matrix(), Eigen::Vector3d(v[0], v[1], v[2]), belief.hits});
    });
  }
  for (const VoxelBox& tile : snapshot.tiles) {
    std::size_t size = 0;
    while (size + 1 < kTileShifts.size() && !is_in_one_cube(tile, kTileShifts[size])) ++size;
    unknown_cubes_[size].insert(cube_number(tile.min, kTileShifts[size]));
  }
}

std::size_t BeliefBricks::brick_at(Index3 origin) {
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
  if (!workspace_.contains(v)) return false;
  for (std::size_t size = 0; size < kTileShifts.size(); ++size) {
    if (unknown_cubes_[size].contains(cube_number(v, kTileShifts[size]))) return true;
  }
  return false;
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

BrickNeighborhood::BrickNeighborhood(const BeliefBricks& bricks, std::size_t center)
    : bricks_(bricks) {
  const Index3 origin = bricks.origin(center);
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
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int x = -kRadius; x <= kRadius; ++x) {
    for (int y = -kRadius; y <= kRadius; ++y) {
      for (int z = -kRadius; z <= kRadius; ++z) {
        const Index3 v{voxel.x + x, voxel.y + y, voxel.z + z};
        const std::int32_t brick = brick_of(v);
        bool free, unknown;
        if (brick != BeliefBricks::kNone) {
          free = bricks_.is_free(static_cast<std::size_t>(brick), block_offset(v));
          unknown = bricks_.is_unknown(static_cast<std::size_t>(brick), block_offset(v));
        } else {
          unknown = bricks_.is_unknown_tile(v);
          free = !unknown;
        }
        const Eigen::Vector3d d(x, y, z);
        if (free) sum += d;
        if (unknown) sum -= d;
      }
    }
  }
  return sum;
}

}  // namespace viewgain::detail
