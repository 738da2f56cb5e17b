// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// Frontal sigmas of a sensor as polynomials of the range t [m], which all noise models are:
/// sigma_ax = a0 + a1 t + a2 (t - v)², sigma_lat = l0 + l1 t.
struct FrontalSigmas {
  double a0 = 0, a1 = 0, a2 = 0, v = 0;
  double l0 = 0, l1 = 0;
  double p0 = 0, p2 = 0;  ///< variances that the pose adds: p0, across the ray p0 + p2 t²
};

/// A sensor's.
[[nodiscard]] FrontalSigmas frontal_sigmas(const Sensor& sensor);

}  // namespace viewgain::detail
