// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view_driver.hpp"

namespace viewgain::detail {

/// Gains of views by some of their rays, for the evaluator of one scene. Thread safe.
class SampledViews {
 public:
  /// The rays of a lattice of the evaluator's. `full` must outlive it.
  SampledViews(const VoxelScene& scene, const ViewDriver& full, const RayLattice& lattice);

  /// The estimate; NaN for a bad pose. `lease` is one of the full driver.
  [[nodiscard]] ApproximateGain estimate(const Pose& T_world_camera,
                                         ViewDriver::Lease& lease) const;
  /// Of the lattice's rays; leases are the full driver's here, too.
  [[nodiscard]] const ViewDriver& driver() const { return driver_; }
  /// That are traced for a view.
  [[nodiscard]] std::uint32_t rays() const { return driver_.core()->ray_count; }

 private:
  [[nodiscard]] double standard_error(const SampleTally& tally) const;

  ViewDriver driver_;
  double step_squared_;
  double scale_;  // rays of the view over those that a sample's would stand for
  std::array<double, kTileRays> lane_share_;  // of the sample's rays
};

}  // namespace viewgain::detail
