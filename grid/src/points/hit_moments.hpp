// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "belief_bricks.hpp"

namespace viewgain::detail {

/// Sums over the readings in balls around the voxels of one brick: w = hits, d = vector from the
/// ball's centre to a voxel's centre [voxels]. A ball ignores voxels on the other face of a wall,
/// because both faces together would look like one thick cloud. These are voxels whose free side is
/// more than 120° from the coordinate axis nearest to the central voxel's free side. With prefix
/// sums along z, a ball costs two look-ups per row. Sums are integers below 2^53, hence exact in
/// any order.
class HitMoments {
 public:
  struct Sums {
    double weight = 0;                                 ///< Σ w
    Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< Σ w d
    Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< Σ w d dᵀ
  };

  /// Balls of a radius of at most BrickNeighborhood::kMaxReach [voxels].
  explicit HitMoments(double radius)
      : reach_(static_cast<int>(radius)), edge_(kBlockSize + 2 * reach_) {
    for (int x = -reach_; x <= reach_; ++x) {
      for (int y = -reach_; y <= reach_; ++y) {
        int half = -1;
        while (x * x + y * y + (half + 1) * (half + 1) <= radius * radius) ++half;
        halves_.push_back(half);
      }
    }
  }

  /// Starts a brick: later balls are around its voxels, of which this is the first.
  void look_at(const BrickNeighborhood& around, Index3 origin) {
    around_ = around;
    origin_ = origin;
    is_ready_ = {};
  }

  /// Sums of the ball around a voxel of the brick with this free side; zero ignores nothing.
  [[nodiscard]] Sums round(unsigned offset, const Eigen::Vector3d& toward_free) {
    const std::size_t side = side_of(toward_free);
    if (!is_ready_[side]) add_up(side);
    const std::vector<Eigen::Array3d>& up_to = up_to_[side];
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
        const Eigen::Array3d* const row = &up_to[static_cast<std::size_t>(
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
  static constexpr std::size_t kSides = 7;  // both directions along three axes, and none
  static constexpr double kOther = -0.5;    // cosine from which a voxel is on the other side

  [[nodiscard]] static std::size_t side_of(const Eigen::Vector3d& toward_free) {
    Eigen::Index axis = 0;
    if (toward_free.cwiseAbs().maxCoeff(&axis) == 0) return kSides - 1;
    return 2 * static_cast<std::size_t>(axis) + (toward_free[axis] < 0 ? 1 : 0);
  }

  [[nodiscard]] static bool is_other(const Eigen::Vector3d& toward_free, std::size_t side) {
    if (side == kSides - 1) return false;
    const double along = toward_free[static_cast<Eigen::Index>(side / 2)];
    return (side % 2 == 0 ? along : -along) < kOther * toward_free.norm();
  }

  void add_up(std::size_t side) {
    std::vector<Eigen::Array3d>& up_to = up_to_[side];
    up_to.resize(static_cast<std::size_t>(edge_ * edge_ * (edge_ + 1)));
    std::size_t row = 0;
    for (int x = -reach_; x < kBlockSize + reach_; ++x) {
      for (int y = -reach_; y < kBlockSize + reach_; ++y) {
        Eigen::Array3d sum = Eigen::Array3d::Zero();
        for (int z = 0; z < edge_; ++z) {
          up_to[row++] = sum;
          const PlacedBelief* const belief =
              around_->find({origin_.x + x, origin_.y + y, origin_.z + z - reach_});
          if (belief != nullptr && !is_other(belief->toward_free, side)) {
            sum += static_cast<double>(belief->hits) * Eigen::Array3d(1, z, z * z);
          }
        }
        up_to[row++] = sum;
      }
    }
    is_ready_[side] = true;
  }

  int reach_, edge_;         // [voxels]
  std::vector<int> halves_;  // of a ball's rows along z; -1: none
  std::optional<BrickNeighborhood> around_;
  Index3 origin_{};
  // By side: Σ w (1, z, z²) of a row below z, with z from the row's begin.
  std::array<std::vector<Eigen::Array3d>, kSides> up_to_;
  std::array<bool, kSides> is_ready_{};
};

}  // namespace viewgain::detail
