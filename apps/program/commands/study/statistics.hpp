// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace viewgain::app {

/// Places from 1 on by rising value; equal values share the mean of theirs. No NaN among them.
[[nodiscard]] std::vector<double> ranks(std::span<const double> values);

/// Spearman's rank correlation of pairs, ties by mean places; pairs of which one is not finite do
/// not count. NaN with fewer than two pairs, or where one side is the same throughout.
[[nodiscard]] double spearman(std::span<const double> a, std::span<const double> b);

/// Mean, and its standard error; NaN of none, the error NaN of one. Values that are not finite do
/// not count.
struct MeanWithError {
  double mean, error;
  std::size_t count;
};
[[nodiscard]] MeanWithError mean_of(std::span<const double> values);

}  // namespace viewgain::app
