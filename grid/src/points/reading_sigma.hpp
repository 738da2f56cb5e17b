// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "viewgain/core/covariance.hpp"

namespace viewgain::detail {

/// Variance of one reading across its ray [m²], from the sum Λ of the information of `hits`
/// readings, assuming one common direction d: Λ = hits (a I + (b - a) d dᵀ). With T = tr Λ and Q =
/// |Λ|², 6 a² - 4 T a + T² - Q = 0; of the two roots the one above T / 3 if the deviator's
/// determinant, -2 (a - b)³ / 27, is negative.
[[nodiscard]] inline double lateral_variance(const SymmetricMatrix3& sum, double hits) {
  const double T = sum.xx + sum.yy + sum.zz;
  const double off = sum.xy * sum.xy + sum.xz * sum.xz + sum.yz * sum.yz;
  const double Q = sum.xx * sum.xx + sum.yy * sum.yy + sum.zz * sum.zz + 2 * off;
  const double x = sum.xx - T / 3, y = sum.yy - T / 3, z = sum.zz - T / 3;
  const double determinant = x * (y * z - sum.yz * sum.yz) -
                             sum.xy * (sum.xy * z - sum.yz * sum.xz) +
                             sum.xz * (sum.xy * sum.yz - y * sum.xz);
  const double root = std::sqrt(std::max(6 * Q - 2 * T * T, 0.0));
  return 6 * hits / (2 * T + (determinant <= 0 ? root : -root));
}

}  // namespace viewgain::detail
