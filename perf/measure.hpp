// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <span>
#include <string>

namespace viewgain::bench {

/// Wall time of a call [s].
template <typename Call>
[[nodiscard]] double seconds_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The value below which the given share of a sample lies, interpolated between neighbours.
[[nodiscard]] double quantile(std::span<const double> sample, double share);

[[nodiscard]] inline double median(std::span<const double> sample) { return quantile(sample, 0.5); }

/// Spearman's rank correlation of two samples of the same size, at least 2.
[[nodiscard]] double rank_correlation(std::span<const double> a, std::span<const double> b);

/// The name of the CPU from the operating system.
[[nodiscard]] std::string cpu_name();

}  // namespace viewgain::bench
