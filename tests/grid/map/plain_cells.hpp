// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::test {

constexpr double kV = 0.01;  // of a voxel [m]
using Key = std::tuple<int, int, int>;

/// A map kept the plain way: a state and a log-odds a voxel, cells in a list, all in double.
class PlainCells {
 public:
  struct Cell {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    std::uint64_t hits = 0;
  };

  explicit PlainCells(const BeliefGrid& grid)
      : box_(VoxelBox::from_dims(grid.min_index(), grid.dims())) {}

  [[nodiscard]] int scale(Index3 v) const {
    const auto found = scales_.find(leaf_of(v));
    return found == scales_.end() ? 0 : found->second;
  }
  [[nodiscard]] std::optional<float> log_odds(Index3 v) const {
    const auto found = log_odds_.find({v.x, v.y, v.z});
    return found == log_odds_.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] std::map<Key, Cell>& cells() { return cells_; }

  void set(Index3 v, float log_odds, const std::optional<Belief>& belief) {
    const Index3 low = lowest(v, scale(v));
    for_each_in(low, scale(v), [&](Index3 at) { log_odds_[{at.x, at.y, at.z}] = log_odds; });
    cells_.erase({low.x, low.y, low.z});
    if (!belief) {
      const Index3 corner = lowest(v, 3);
      drop_scale_if_uniform({corner, {corner.x + 8, corner.y + 8, corner.z + 8}});
      return;
    }
    const auto& e = belief->information_vector;
    cells_[{low.x, low.y, low.z}] = {belief->information_matrix().matrix(),
                                     Eigen::Vector3d(e[0], e[1], e[2]), belief->hits};
  }

  void resample(const VoxelBox& region, int wanted) {
    for (int x = box_.min.x & ~7; x < box_.max.x; x += 8) {
      for (int y = box_.min.y & ~7; y < box_.max.y; y += 8) {
        for (int z = box_.min.z & ~7; z < box_.max.z; z += 8) {
          const VoxelBox leaf{{x, y, z}, {x + 8, y + 8, z + 8}};
          if (leaf.intersection(region).volume() > 0) resample_leaf(leaf, wanted);
        }
      }
    }
  }

 private:
  static Key leaf_of(Index3 v) { return {v.x >> 3, v.y >> 3, v.z >> 3}; }
  static Index3 lowest(Index3 v, int scale) {
    const auto down = [&](std::int32_t i) { return (i >> scale) * (1 << scale); };
    return {down(v.x), down(v.y), down(v.z)};
  }
  static Eigen::Vector3d center(Index3 low, int scale) {
    const double half = 0.5 * std::pow(2.0, scale);
    return Eigen::Vector3d(low.x + half, low.y + half, low.z + half) * kV;
  }
  template <typename F>
  static void for_each_in(Index3 low, int scale, F&& f) {
    for (int i = 0; i < 1 << 3 * scale; ++i) {
      const int edge = 1 << scale;
      f(Index3{low.x + i / (edge * edge), low.y + i / edge % edge, low.z + i % edge});
    }
  }

  void resample_leaf(const VoxelBox& leaf, int to) {
    const VoxelBox part = leaf.intersection(box_);
    const auto fits = [&](int s) {
      for (const int face :
           {part.min.x, part.min.y, part.min.z, part.max.x, part.max.y, part.max.z}) {
        if (face % (1 << s) != 0) return false;
      }
      return true;
    };
    while (!fits(to)) --to;
    const int from = scale(leaf.min);
    std::set<std::optional<float>> values;
    std::map<Key, Cell> own;
    for_each_in(leaf.min, 3, [&](Index3 v) {
      if (!box_.contains(v)) return;
      values.insert(log_odds(v));
      const auto found = cells_.find({v.x, v.y, v.z});
      if (found == cells_.end()) return;
      own.insert(*found);
      cells_.erase(found);
    });
    const bool is_uniform = values.size() == 1 && values.begin()->value_or(0) <= 0;
    if (is_uniform && own.empty()) {
      scales_.erase(leaf_of(leaf.min));
      return;
    }
    if (to > from) {
      for (int x = part.min.x; x < part.max.x; x += 1 << to) {
        for (int y = part.min.y; y < part.max.y; y += 1 << to) {
          for (int z = part.min.z; z < part.max.z; z += 1 << to) {
            join({x, y, z}, to, std::any_of(own.begin(), own.end(), [&](const auto& one) {
                   const auto& [a, b, c] = one.first;
                   return lowest({a, b, c}, to) == Index3{x, y, z};
                 }));
          }
        }
      }
    }
    for (const auto& [key, cell] : own) {
      const auto& [x, y, z] = key;
      const Index3 low{x, y, z};
      Index3 at = lowest(low, to);
      if (to < from) {
        const Eigen::Vector3d mean =
            (center(low, from) + cell.information.ldlt().solve(cell.vector)) / kV;
        const auto child = [&](double p, int first) {
          return std::clamp(static_cast<int>(std::floor(p)), first, first + (1 << from) - 1);
        };
        at = lowest({child(mean.x(), x), child(mean.y(), y), child(mean.z(), z)}, to);
        if (log_odds(low).value_or(0) > 0) {
          const float value = *log_odds(low);
          for_each_in(low, from, [&](Index3 v) { log_odds_.erase({v.x, v.y, v.z}); });
          for_each_in(at, to, [&](Index3 v) { log_odds_[{v.x, v.y, v.z}] = value; });
        }
      }
      Cell& sum = cells_[{at.x, at.y, at.z}];
      sum.information += cell.information;
      sum.vector += cell.vector + cell.information * (center(low, from) - center(at, to));
      sum.hits += cell.hits;
    }
    to > 0 ? void(scales_[leaf_of(leaf.min)] = to) : void(scales_.erase(leaf_of(leaf.min)));
    drop_scale_if_uniform(leaf);
  }

  // A uniform leaf without beliefs that is not occupied has no scale.
  void drop_scale_if_uniform(const VoxelBox& leaf) {
    std::set<std::optional<float>> values;
    bool has_cells = false;
    for_each_in(leaf.min, 3, [&](Index3 v) {
      if (!box_.contains(v)) return;
      values.insert(log_odds(v));
      has_cells = has_cells || cells_.contains({v.x, v.y, v.z});
    });
    if (!has_cells && values.size() == 1 && values.begin()->value_or(0) <= 0) {
      scales_.erase(leaf_of(leaf.min));
    }
  }

  // Occupied if a voxel is, as sure as the surest; else unknown if one is, and no reading ended
  // there; else the least free.
  void join(Index3 low, int to, bool is_read) {
    float most = -3;
    bool unknown = false;
    for_each_in(low, to, [&](Index3 v) {
      unknown = unknown || !log_odds(v);
      most = std::max(most, log_odds(v).value_or(-3));
    });
    for_each_in(low, to, [&](Index3 v) {
      if (most > 0 || !unknown || is_read) {
        log_odds_[{v.x, v.y, v.z}] = most;
      } else {
        log_odds_.erase({v.x, v.y, v.z});
      }
    });
  }

  VoxelBox box_;
  std::map<Key, int> scales_;
  std::map<Key, float> log_odds_;
  std::map<Key, Cell> cells_;
};

}  // namespace viewgain::test
