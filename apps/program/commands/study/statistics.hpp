// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace viewgain::app {

/// Mean, and its standard error; NaN of none, the error NaN of one. Values that are not finite do
/// not count.
struct MeanWithError {
  double mean, error;
  std::size_t count;
};
/// `clusters`, a number a value, says which belong together, as runs on one object do. The error is
/// the cluster-robust one, CR1: its square is G / (G - 1) times the sum over the G clusters of
/// their squared sums of deviations, by the squared count (Cameron and Miller, A Practitioner's
/// Guide to Cluster-Robust Inference, Journal of Human Resources 50, 2015). Where all are of
/// one cluster, or none is given, values count as independent; where of several one alone has
/// finite values there is no error: NaN.
[[nodiscard]] MeanWithError mean_of(std::span<const double> values,
                                    std::span<const std::size_t> clusters = {});

/// The middle value, or the mean of the middle two; infinities may be among them. NaN of none.
[[nodiscard]] double median_of(std::vector<double> values);

/// How probable differences would be that are at least as one-sided if either sign were as likely
/// as the other: of the numbers of signs alone (two-sided sign test), and of the ranks of the sizes
/// (two-sided Wilcoxon signed-rank test, equal sizes at mean places). Zeros and what is not finite
/// do not count; 1 of none. Exact, given the places, for up to 100 differences (the first: 1,000);
/// beyond by the normal distribution, its variance that of the places as tied.
[[nodiscard]] double sign_test(std::span<const double> differences);
[[nodiscard]] double signed_rank_test(std::span<const double> differences);

}  // namespace viewgain::app
