// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace viewgain::detail {

/// A Gaussian's standard deviation by its median amount.
inline constexpr double kSigmaByMedian = 1.4826;

/// The standard deviation of the median of n Gaussian values, times √n, by theirs.
inline constexpr double kMedianSigma = 1.2533;

/// The value in the middle, of an even count the mean of both; there is at least one.
[[nodiscard]] inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace viewgain::detail
