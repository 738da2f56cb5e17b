// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace viewgain::app {

std::vector<double> ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> places(values.size());
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && !(values[order[first]] < values[order[last]])) ++last;
    const double place = 0.5 * static_cast<double>(first + 1 + last);
    for (std::size_t i = first; i < last; ++i) places[order[i]] = place;
  }
  return places;
}

double spearman(std::span<const double> a, std::span<const double> b) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    x.push_back(a[i]);
    y.push_back(b[i]);
  }
  x = ranks(x), y = ranks(y);
  const double middle = 0.5 * static_cast<double>(x.size() + 1);
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - middle, dy = y[i] - middle;
    xx += dx * dx, yy += dy * dy, xy += dx * dy;
  }
  if (!(xx > 0 && yy > 0)) return std::numeric_limits<double>::quiet_NaN();
  return xy / std::sqrt(xx * yy);
}

MeanWithError mean_of(std::span<const double> values) {
  MeanWithError result{0, 0, 0};
  for (const double value : values) {
    if (std::isfinite(value)) result.mean += value, ++result.count;
  }
  const auto n = static_cast<double>(result.count);
  if (result.count == 0) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    return {kNothing, kNothing, 0};
  }
  result.mean /= n;
  double squares = 0;
  for (const double value : values) {
    if (std::isfinite(value)) squares += (value - result.mean) * (value - result.mean);
  }
  result.error = result.count > 1 ? std::sqrt(squares / (n - 1) / n)
                                  : std::numeric_limits<double>::quiet_NaN();
  return result;
}

}  // namespace viewgain::app
