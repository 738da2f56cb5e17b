// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "evaluator_core.hpp"
#include "view_driver.hpp"

namespace viewgain::detail {

/// The step of a lattice that leaves about so many of a view's rays; at least 1.
[[nodiscard]] int step_for_rays(const EvaluatorCore& core, double rays);
/// The smallest step of a lattice that has at most this share of a view's rays, but not under 100.
[[nodiscard]] int step_for_share(const EvaluatorCore& core, double share);

/// In the middle of the image.
[[nodiscard]] RayLattice centred_lattice(const EvaluatorCore& core, int step);
/// Somewhere: any ray has the same chance to be in it.
[[nodiscard]] RayLattice random_lattice(const EvaluatorCore& core, int step, std::uint64_t seed);

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
