// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>

namespace viewgain::app {
namespace {

// Places from 1 on by rising value; equal values share the mean of theirs.
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

// Two-sided p of the sum of weights of the positive differences, where either sign is as likely:
// the weights are 1, or twice the places by size, so that those of ties are whole.
double flip_test(std::span<const double> differences, bool by_size) {
  constexpr std::size_t kMostExact = 1'010'000;  // sums, 100 differences by size
  std::vector<double> sizes;
  std::vector<bool> is_positive;
  for (const double d : differences) {
    if (!std::isfinite(d) || d == 0) continue;
    sizes.push_back(std::abs(d));
    is_positive.push_back(d > 0);
  }
  std::vector<std::size_t> weights;
  std::size_t all = 0, sum = 0;
  double squares = 0;
  for (const double place : ranks(sizes)) {
    const std::size_t weight = by_size ? static_cast<std::size_t>(2 * place) : 1;
    if (is_positive[weights.size()]) sum += weight;
    all += weight;
    squares += static_cast<double>(weight * weight);
    weights.push_back(weight);
  }
  if (weights.size() * all > kMostExact) {
    const double off = static_cast<double>(sum) - 0.5 * static_cast<double>(all);
    return std::erfc(std::abs(off) / std::sqrt(0.5 * squares));
  }
  // How probable each sum is, with one difference more at a time.
  std::vector<double> probability(all + 1, 0.0);
  probability[0] = 1;
  for (const std::size_t weight : weights) {
    for (std::size_t s = all + 1; s-- > 0;) {
      probability[s] = 0.5 * (probability[s] + (s >= weight ? probability[s - weight] : 0));
    }
  }
  const auto tail = static_cast<std::ptrdiff_t>(std::min(sum, all - sum)) + 1;
  return std::min(1.0, 2 * std::accumulate(probability.begin(), probability.begin() + tail, 0.0));
}

}  // namespace

MeanWithError mean_of(std::span<const double> values, std::span<const std::size_t> clusters) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  MeanWithError result{0, kNothing, 0};
  for (const double value : values) {
    if (std::isfinite(value)) result.mean += value, ++result.count;
  }
  if (result.count == 0) return {kNothing, kNothing, 0};
  const auto n = static_cast<double>(result.count);
  result.mean /= n;
  const bool by_cluster = std::any_of(clusters.begin(), clusters.end(),
                                      [&](std::size_t c) { return c != clusters.front(); });
  std::map<std::size_t, double> sums;  // of deviations
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) sums[by_cluster ? clusters[i] : i] += values[i] - result.mean;
  }
  const auto groups = static_cast<double>(sums.size());
  double squares = 0;
  for (const auto& [cluster, sum] : sums) squares += sum * sum;
  if (groups > 1) result.error = std::sqrt(groups / (groups - 1) * squares) / n;
  return result;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double sign_test(std::span<const double> differences) { return flip_test(differences, false); }
double signed_rank_test(std::span<const double> differences) {
  return flip_test(differences, true);
}

}  // namespace viewgain::app
