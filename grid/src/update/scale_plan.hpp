// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <vector>

#include "map/belief_blocks.hpp"
#include "readings.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::detail {

/// Wanted scale of a block: the one whose cells are nearest in size to the larger of a pixel's
/// footprint and sigma_ax, at the range of the block's nearest point, and not below the finest; 0
/// in the fine boxes.
class ScalePlan {
 public:
  /// Throws like FrameIntegrator's constructor.
  explicit ScalePlan(const IntegrationConfig& config);

  /// Starts a frame and map, which must outlive the queries.
  void look(const PlacedFrame& frame, const BeliefGrid& map);

  /// Whether all leaves have and keep scale 0.
  [[nodiscard]] bool is_idle() const { return coarsest_ == 0 && !has_scales(*map_); }
  /// Scale of a block that stores nothing by cells yet.
  [[nodiscard]] int of_new(Index3 origin) const { return wanted(origin, 1.0); }
  /// Scale of a block that has one: it stays unless the wanted scale is finer by a margin of a
  /// quarter, so that views at a threshold's range do not toggle it.
  [[nodiscard]] int of_held(Index3 origin, int scale) const {
    return scale == 0 ? 0 : std::min(scale, wanted(origin, 1.25));
  }
  /// Sets the scale of a hit block.
  void set(BeliefGrid& map, std::uint64_t key) const;

 private:
  [[nodiscard]] int wanted(Index3 origin, double margin) const;

  int coarsest_, finest_;
  std::vector<Box> fine_;
  const PlacedFrame* frame_ = nullptr;
  const BeliefGrid* map_ = nullptr;
  std::optional<BlockLattice> lattice_;
  Eigen::Vector3d eye_ = Eigen::Vector3d::Zero();  // grid's frame [m]
};

}  // namespace viewgain::detail
