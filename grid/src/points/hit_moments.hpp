// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "belief_bricks.hpp"

namespace viewgain::detail {

/// What the readings in balls round voxels of one brick sum up to: w = hits, d = from the ball's
/// middle to a voxel's centre [voxels]. Sums along z stand ready, so that a ball costs two looks a
/// row of it. They are of whole numbers below 2^53, hence exact in any order.
class HitMoments {
 public:
  struct Sums {
    double weight = 0;                                 ///< Σ w
    Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< Σ w d
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< Σ w d dᵀ
  };

  /// Balls of a radius of at most BrickNeighborhood::kMaxReach [voxels].
  explicit HitMoments(double radius)
      : reach_(static_cast<int>(radius)),
        edge_(kBlockSize + 2 * reach_),
        up_to_(static_cast<std::size_t>(edge_ * edge_ * (edge_ + 1))) {
    for (int x = -reach_; x <= reach_; ++x) {
      for (int y = -reach_; y <= reach_; ++y) {
        int half = -1;
        while (x * x + y * y + (half + 1) * (half + 1) <= radius * radius) ++half;
        halves_.push_back(half);
      }
    }
  }

  /// From here on the balls are round voxels of the brick in the middle, whose first voxel this is.
  void look_at(const BrickNeighborhood& around, Index3 origin) {
    std::size_t row = 0;
    for (int x = -reach_; x < kBlockSize + reach_; ++x) {
      for (int y = -reach_; y < kBlockSize + reach_; ++y) {
        Eigen::Array3d sum = Eigen::Array3d::Zero();
        for (int z = 0; z < edge_; ++z) {
          up_to_[row++] = sum;
          const PlacedBelief* const belief =
              around.find({origin.x + x, origin.y + y, origin.z + z - reach_});
          if (belief != nullptr)
            sum += static_cast<double>(belief->hits) * Eigen::Array3d(1, z, z * z);
        }
        up_to_[row++] = sum;
      }
    }
  }

  /// Of the ball round a voxel of the brick.
  [[nodiscard]] Sums round(unsigned offset) const {
    const Index3 middle = offset_voxel({0, 0, 0}, offset);
    const int z = middle.z + reach_;
    Eigen::Array3d all = Eigen::Array3d::Zero(), by_x = all, by_y = all;
    Sums sums;
    auto half = halves_.begin();
    for (int x = 0; x <= 2 * reach_; ++x) {
      const double dx = x - reach_;
      Eigen::Array3d rows = Eigen::Array3d::Zero(), rows_by_y = rows;
      for (int y = 0; y <= 2 * reach_; ++y, ++half) {
        if (*half < 0) continue;
        const Eigen::Array3d* const row = &up_to_[static_cast<std::size_t>(
            ((middle.x + x) * edge_ + middle.y + y) * (edge_ + 1) + z)];
        const Eigen::Array3d run = row[*half + 1] - row[-*half];
        const double dy = y - reach_;
        rows += run;
        rows_by_y += dy * run;
        sums.second(1, 1) += dy * dy * run[0];
      }
      all += rows;
      by_x += dx * rows;
      by_y += rows_by_y;
      sums.second(0, 0) += dx * dx * rows[0];
      sums.second(1, 0) += dx * rows_by_y[0];
    }
    sums.weight = all[0];
    sums.first = {by_x[0], by_y[0], all[1] - z * all[0]};
    sums.second(2, 0) = by_x[1] - z * by_x[0];
    sums.second(2, 1) = by_y[1] - z * by_y[0];
    sums.second(2, 2) = all[2] - 2 * z * all[1] + z * z * all[0];
    sums.second.triangularView<Eigen::StrictlyUpper>() = sums.second.transpose();
    return sums;
  }

 private:
  int reach_, edge_;                   // [voxels]
  std::vector<int> halves_;            // of a ball's rows along z; -1: none
  std::vector<Eigen::Array3d> up_to_;  // Σ w (1, z, z²) of a row below z, z from the row's begin
};

/// Items by the cube that a position lies in; cubes that share a key do no harm to callers that
/// check distances.
template <typename Item>
class PointCells {
 public:
  /// Edge of a cube; what is within it of a position lies in the 27 cubes round it.
  explicit PointCells(double edge) : edge_(edge) {}

  [[nodiscard]] std::vector<Item>& at(const Eigen::Vector3d& p) {
    return cells_[key(cell(p.x()), cell(p.y()), cell(p.z()))];
  }

  /// f(item) for all items in the cube of p and its neighbours, in a fixed order.
  template <typename F>
  void for_each_near(const Eigen::Vector3d& p, F&& f) const {
    const std::int64_t x = cell(p.x()), y = cell(p.y()), z = cell(p.z());
    for (std::int64_t i = x - 1; i <= x + 1; ++i) {
      for (std::int64_t j = y - 1; j <= y + 1; ++j) {
        for (std::int64_t k = z - 1; k <= z + 1; ++k) {
          const auto found = cells_.find(key(i, j, k));
          if (found == cells_.end()) continue;
          for (const Item& item : found->second) f(item);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::int64_t cell(double v) const {
    return static_cast<std::int64_t>(std::floor(v / edge_));
  }
  [[nodiscard]] static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
           static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
           static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ULL;
  }

  double edge_;
  std::unordered_map<std::uint64_t, std::vector<Item>> cells_;
};

}  // namespace viewgain::detail
