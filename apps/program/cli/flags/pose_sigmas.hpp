// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "program/cli/json.hpp"
#include "viewgain/planner/pose_noise.hpp"

namespace viewgain::app {

/// The sigmas [m, deg]; null where both are 0.
[[nodiscard]] inline Json pose_sigmas_json(const PoseNoise& noise) {
  if (noise.sigma_translation == 0 && noise.sigma_rotation == 0) return {};
  return {noise.sigma_translation, noise.sigma_rotation * 180 / std::numbers::pi};
}

}  // namespace viewgain::app
