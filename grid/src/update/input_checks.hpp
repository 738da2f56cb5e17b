// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>

#include "viewgain/core/error.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

/// Throws Error(invalid_argument) unless the support plane, if there is one, is finite.
inline void check_plane(std::optional<double> height) {
  if (height && !std::isfinite(*height)) {
    throw Error(ErrorCode::invalid_argument,
                "support plane " + short_text(*height) + " m is not finite");
  }
}

/// Throws Error(invalid_argument) unless both sigmas are finite and not negative.
inline void check_pose_sigma(const PoseSigma& pose_sigma) {
  for (const double sigma : {pose_sigma.translation, pose_sigma.rotation}) {
    if (std::isfinite(sigma) && sigma >= 0) continue;
    throw Error(ErrorCode::invalid_argument,
                "the sigma " + short_text(sigma) + " of a pose is negative or not finite");
  }
}

}  // namespace viewgain::detail
