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

/// Which scale a frame wants for a block: that whose cells are nearest in size to the larger of a
/// pixel's footprint and sigma_ax, at the range of the block's nearest point, and not below the
/// finest; 0 in the fine boxes.
class ScalePlan {
 public:
  /// Throws as FrameIntegrator's constructor.
  explicit ScalePlan(const IntegrationConfig& config);

  /// From here on of this frame and map; both must live as long as they are asked about.
  void look(const PlacedFrame& frame, const BeliefGrid& map);

  /// Whether all leaves have scale 0 and keep it.
  [[nodiscard]] bool is_idle() const { return coarsest_ == 0 && !has_scales(*map_); }
  /// Of a block that holds nothing by cells yet.
  [[nodiscard]] int of_new(Index3 origin) const { return wanted(origin, 1.0); }
  /// Of one that has a scale, which stays unless this is finer by a quarter more than it must: what
  /// is seen from about a threshold's range does not go to and fro.
  [[nodiscard]] int of_held(Index3 origin, int scale) const {
    return scale == 0 ? 0 : std::min(scale, wanted(origin, 1.25));
  }
  /// Gives a block that is hit its scale.
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
