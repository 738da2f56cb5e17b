// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A voxel's belief in double precision.
struct PlacedBelief {
  SymmetricMatrix3 information{};                    ///< Λ_v [m⁻²]
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();  ///< η_v [m⁻¹]
  std::uint32_t hits = 0;
  SymmetricMatrix3 covariance{};                   ///< Λ_v⁻¹ [m²]
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< Λ_v⁻¹ η_v, from the centre [voxels]
  /// BrickNeighborhood::free_side() of the voxel's centre, after BeliefBricks::find_sides().
  Eigen::Vector3d toward_free = Eigen::Vector3d::Zero();
};

/// Beliefs and states of a map, arranged for access to a voxel's neighbours: in bricks of 8³
/// voxels, or of 8³ cubes of 2^shift voxels per edge with summed beliefs. A cube is occupied if one
/// of its voxels is, otherwise free if one is. Cubes are called voxels too. Ignores beliefs of
/// cells larger than these cubes.
class BeliefBricks {
 public:
  static constexpr std::int32_t kNone = -1;

  BeliefBricks(const GridSnapshot& snapshot, const std::vector<BeliefBlockAt>& blocks, int shift);

  /// Computes the free side of each belief. Cost: about 0.1 µs per belief.
  void find_sides(ThreadPool& pool);

  /// Occupied voxels with a belief: brick and offset, in a fixed order.
  [[nodiscard]] std::vector<std::pair<std::size_t, unsigned>> occupied_with_belief() const;

  [[nodiscard]] Index3 origin(std::size_t brick) const { return bricks_[brick].origin; }
  [[nodiscard]] const PlacedBelief* find(std::size_t brick, unsigned offset) const {
    const std::int32_t i = bricks_[brick].belief[offset];
    return i == kNone ? nullptr : &beliefs_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const LeafMask& non_free(std::size_t brick) const {
    return bricks_[brick].non_free;
  }
  [[nodiscard]] const LeafMask& occupied(std::size_t brick) const {
    return bricks_[brick].occupied;
  }

  /// Index of the brick with this origin, kNone if there is none.
  [[nodiscard]] std::int32_t number(Index3 origin) const;
  /// State of a voxel in a block without a brick, which is uniform. O(1).
  [[nodiscard]] bool is_unknown_tile(Index3 voxel) const;
  /// Part of the lattice of these voxels that the workspace touches.
  [[nodiscard]] VoxelBox workspace_cells() const;

 private:
  struct Brick {
    Index3 origin;
    LeafMask non_free{};
    LeafMask occupied{};
    std::array<std::int32_t, kBlockVoxels> belief{};
  };
  /// Edges of a snapshot's tiles before clipping, as powers of two.
  static constexpr std::array<unsigned, 3> kTileShifts{3, 7, 11};

  [[nodiscard]] Index3 cell_of(Index3 voxel) const {
    return {voxel.x >> shift_, voxel.y >> shift_, voxel.z >> shift_};
  }
  /// Index of the brick that contains a leaf of the map; creates it if missing.
  std::size_t brick_at(Index3 leaf);
  /// State of a map voxel in a uniform leaf.
  [[nodiscard]] bool is_unknown_voxel(Index3 voxel) const;
  void add_beliefs(const BeliefBlockAt& block, double voxel_size);
  void find_states(const GridSnapshot& snapshot);

  std::vector<Brick> bricks_;
  std::vector<PlacedBelief> beliefs_;
  std::unordered_map<std::uint64_t, std::int32_t> numbers_;
  /// Cubes that are entirely unknown within the workspace, by size of tile.
  std::array<std::unordered_set<std::uint64_t>, kTileShifts.size()> unknown_cubes_;
  VoxelBox workspace_;
  int shift_;
};

/// A brick and its 26 neighbours.
class BrickNeighborhood {
 public:
  /// Largest radius and half height of a search [voxels]: one further brick.
  static constexpr double kMaxReach = kBlockSize;

  BrickNeighborhood(const BeliefBricks& bricks, std::size_t center)
      : BrickNeighborhood(bricks, bricks.origin(center)) {}
  /// Neighbourhood of a brick position, with or without a brick.
  BrickNeighborhood(const BeliefBricks& bricks, Index3 origin);

  /// Belief of a voxel in the neighbourhood; null if it has none.
  [[nodiscard]] const PlacedBelief* find(Index3 v) const {
    const std::int32_t brick = brick_of(v);
    return brick == BeliefBricks::kNone
               ? nullptr
               : bricks_->find(static_cast<std::size_t>(brick), block_offset(v));
  }

  /// Calls f(belief, vector from `start` to the centre of the belief's voxel [voxels]) for voxels
  /// whose centres are within `radius` of the line start + h n and within `half_height` of start
  /// along it. `start` must be near.
  template <typename F>
  void for_each_in_column(const Eigen::Vector3d& start, const Eigen::Vector3d& n, double radius,
                          double half_height, F&& f) const {
    // By layer along the line's dominant axis.
    Eigen::Index axis = 0;
    const double steepest = n.cwiseAbs().maxCoeff(&axis);
    const Eigen::Index b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double reach = half_height * steepest + radius;
    const double spread = radius / steepest;
    // Sums the centres per component: reading freshly written components as a vector is slow.
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis), unit_b = Eigen::Vector3d::Unit(b),
                          unit_c = Eigen::Vector3d::Unit(c);
    std::array<std::int32_t, 3> v{};
    for (double layer = std::ceil(start[axis] - reach - 0.5); layer + 0.5 <= start[axis] + reach;
         ++layer) {
      v[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(layer);
      const double h = (layer + 0.5 - start[axis]) / n[axis];
      const double at_b = start[b] + h * n[b], at_c = start[c] + h * n[c];
      for (double i = std::ceil(at_b - spread - 0.5); i + 0.5 <= at_b + spread; ++i) {
        v[static_cast<std::size_t>(b)] = static_cast<std::int32_t>(i);
        const Eigen::Vector3d row = (layer + 0.5) * unit + (i + 0.5) * unit_b;
        for (double j = std::ceil(at_c - spread - 0.5); j + 0.5 <= at_c + spread; ++j) {
          const Eigen::Vector3d d = row + (j + 0.5) * unit_c - start;
          const double along = d.dot(n);
          if (std::abs(along) > half_height || d.squaredNorm() - along * along > radius * radius) {
            continue;
          }
          v[static_cast<std::size_t>(c)] = static_cast<std::int32_t>(j);
          const PlacedBelief* belief = find({v[0], v[1], v[2]});
          if (belief != nullptr) f(*belief, d);
        }
      }
    }
  }

  /// Whether the position [voxels] lies in the central brick.
  [[nodiscard]] bool is_centered_on(const Eigen::Vector3d& position) const {
    const Index3 v = containing(position);
    return v.x >> 3 == low_.x + 1 && v.y >> 3 == low_.y + 1 && v.z >> 3 == low_.z + 1;
  }

  /// Whether a search from `position` [voxels] can find anything. Otherwise everything is outside
  /// the neighbourhood, so far away that coordinates lose their digits, or NaN.
  [[nodiscard]] bool is_near(const Eigen::Vector3d& position) const {
    const Eigen::Vector3d middle =
        (Eigen::Vector3d(low_.x, low_.y, low_.z).array() + 1.5) * kBlockSize;
    return ((position - middle).array().abs() <= 1.5 * kBlockSize + kMaxReach).all();
  }

  /// Direction from the unknown voxels around `position` [voxels], which must be near, to the free
  /// ones; zero if there is no difference. Not normalised.
  [[nodiscard]] Eigen::Vector3d free_side(const Eigen::Vector3d& position) const;

  [[nodiscard]] static Index3 containing(const Eigen::Vector3d& position) {
    return {static_cast<std::int32_t>(std::floor(position.x())),
            static_cast<std::int32_t>(std::floor(position.y())),
            static_cast<std::int32_t>(std::floor(position.z()))};
  }

 private:
  /// Voxels of one x in a block as bits, rows along z adjacent.
  struct Layer {
    std::uint64_t free = 0, unknown = 0;
  };
  /// Rows of the voxel's block from its row on; rows are uniform in blocks without a brick.
  [[nodiscard]] Layer layer_from(Index3 v) const;

  /// Index of a voxel's brick, kNone if there is none or it is outside the neighbourhood.
  [[nodiscard]] std::int32_t brick_of(Index3 v) const {
    const std::int32_t x = (v.x >> 3) - low_.x, y = (v.y >> 3) - low_.y, z = (v.z >> 3) - low_.z;
    if (static_cast<std::uint32_t>(x) > 2 || static_cast<std::uint32_t>(y) > 2 ||
        static_cast<std::uint32_t>(z) > 2) {
      return BeliefBricks::kNone;
    }
    return numbers_[static_cast<std::size_t>(9 * x + 3 * y + z)];
  }

  const BeliefBricks* bricks_;
  Index3 low_;  ///< lowest block, in blocks
  std::array<std::int32_t, 27> numbers_{};
};

}  // namespace viewgain::detail
