// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::test {

inline constexpr double kPlaneZ = 0.4;  ///< [m] in front of the camera
inline constexpr double kSigmaAxial = 0.0036, kSigmaLateral = 0.0018;  ///< [m]

[[nodiscard]] Sensor plane_sensor();

/// A frontal plane as a noisy sensor sees it, `frames` times, and `behind` times the other face of
/// a plate of this thickness [m].
[[nodiscard]] BeliefGrid noisy_plane(
    double voxel, int frames, const Pose& T_world_grid = {},
    IntegrationConfig::Occupancy occupancy = IntegrationConfig::Occupancy::probabilistic,
    int behind = 0, double thickness = 0);

}  // namespace viewgain::test
