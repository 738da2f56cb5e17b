// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "program/cli/json.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::app {

/// The sigmas [m, deg]; null where both are 0.
[[nodiscard]] inline Json pose_sigma_json(const PoseSigma& sigma) {
  if (sigma == PoseSigma{}) return {};
  return {sigma.translation, sigma.rotation * 180 / std::numbers::pi};
}

}  // namespace viewgain::app
