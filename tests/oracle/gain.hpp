// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "oracle/rays.hpp"

namespace viewgain::oracle {

/// The gain of raycast/README.md, as sums, for one pose whose rays end in `hits` (pixel order,
/// strided).
[[nodiscard]] ViewGain gain_of_hits(const BeliefGrid& grid, const Sensor& sensor,
                                    const GainConfig& config, const Pose& T_world_camera,
                                    std::span<const RayHit> hits);

/// The most that any one of the hits alone could gain in a voxel without evidence, times the
/// largest weight: what one ray more or less can change.
[[nodiscard]] double largest_one_hit_gain(const BeliefGrid& grid, const Sensor& sensor,
                                          const GainConfig& config, const Pose& T_world_camera,
                                          std::span<const RayHit> hits);

}  // namespace viewgain::oracle
