// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "registration/registration_view.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain::detail {

/// What a map has of the surface that a frame may show: its fused points as the readings of a view
/// from where the frame's pose was reported, which may be off by `sigma`. `frame` has readings;
/// `length` is the map's pooling length [m]. Keeps the grid by reference.
[[nodiscard]] RegistrationView map_view(const BeliefGrid& grid, double length, const Sensor& sensor,
                                        const RegistrationView& frame, const Pose& T_reported,
                                        const PoseSigma& sigma, const ExecConfig& exec);

}  // namespace viewgain::detail
