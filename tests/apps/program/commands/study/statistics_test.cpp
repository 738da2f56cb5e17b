// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "program/commands/study/results.hpp"

namespace viewgain {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// By definition: how many are less, and half of those that are equal.
double rank_by_counting(const std::vector<double>& values, std::size_t i) {
  double less = 0, equal = 0;
  for (const double value : values) {
    less += value < values[i] ? 1 : 0;
    equal += value == values[i] ? 1 : 0;
  }
  return less + 0.5 * (equal + 1);
}

TEST(Statistics, MeanAndItsError) {
  const app::MeanWithError mean = app::mean_of(std::vector<double>{1, 2, kNaN, 3, 6});
  EXPECT_EQ(mean.count, 4U);
  EXPECT_DOUBLE_EQ(mean.mean, 3);
  EXPECT_DOUBLE_EQ(mean.error, std::sqrt(14.0 / 3 / 4));
  EXPECT_TRUE(std::isnan(app::mean_of(std::vector<double>{5}).error));
  EXPECT_TRUE(std::isnan(app::mean_of({}).mean));
}

TEST(Statistics, ErrorsByClusterInClosedForm) {
  using Clusters = std::vector<std::size_t>;
  // Of clusters of one size: the error of the mean of their means, 2, 5 and 8.
  const std::vector<double> values{1, 3, 5, 5, 9, 7};
  EXPECT_DOUBLE_EQ(app::mean_of(values, Clusters{4, 4, 0, 0, 7, 7}).error, std::sqrt(18.0 / 2 / 3));
  // Of two sizes: the sums of deviations are -4 and 4. What is not finite does not count.
  EXPECT_DOUBLE_EQ(app::mean_of(std::vector<double>{1, 3, kNaN, 8}, Clusters{0, 0, 1, 1}).error,
                   std::sqrt(2.0 / 1 * (16 + 16)) / 3);
  // Of two clusters one alone says nothing of others.
  EXPECT_TRUE(std::isnan(app::mean_of(std::vector<double>{1, 3, kNaN}, Clusters{0, 0, 1}).error));
  // Each by itself, or all together: as if they were independent.
  for (const Clusters& clusters : {Clusters{0, 1, 2, 3, 4, 5}, Clusters(6, 2)}) {
    EXPECT_DOUBLE_EQ(app::mean_of(values, clusters).error, app::mean_of(values).error);
  }
}

// Of values that are all one off their object's mean it is t / sqrt(degrees of freedom), t as in
// printed tables of 97.5 %.
TEST(Statistics, IntervalsAreThoseOfStudentsTable) {
  struct Case {
    std::size_t objects, seeds;
    double t;
  };
  std::size_t cases = 0;
  for (const Case& one : {Case{1, 2, 12.706},
                          {2, 2, 4.303},
                          {1, 4, 3.182},
                          {4, 2, 2.776},
                          {1, 6, 2.571},
                          {1, 10, 2.262},
                          {10, 2, 2.228},
                          {10, 4, 2.042},
                          {60, 10, 1.964}}) {
    std::vector<double> values;
    std::vector<std::size_t> objects;
    for (std::size_t i = 0; i < one.objects * one.seeds; ++i) {
      objects.push_back(i / one.seeds);
      values.push_back(static_cast<double>(10 * objects.back()) + (i % 2 == 0 ? 1 : -1));
    }
    values.push_back(kNaN);  // does not count
    objects.push_back(0);
    const auto freedom = static_cast<double>(one.objects * (one.seeds - 1));
    EXPECT_NEAR(app::interval_of(values, objects) * std::sqrt(freedom), one.t, 5e-4) << freedom;
    ++cases;
  }
  EXPECT_EQ(cases, 9U);
  // A run an object says nothing of other seeds.
  EXPECT_TRUE(
      std::isnan(app::interval_of(std::vector<double>{1, 2}, std::vector<std::size_t>{0, 1})));
}

TEST(Statistics, MediansAreInTheMiddle) {
  EXPECT_EQ(app::median_of({3, HUGE_VAL, 1}), 3);
  EXPECT_EQ(app::median_of({4, 1, 3, HUGE_VAL}), 3.5);
  EXPECT_EQ(app::median_of({4, HUGE_VAL}), HUGE_VAL);
  EXPECT_TRUE(std::isnan(app::median_of({})));
}

// By definition: of all ways to give the differences signs, the share that is as far from the
// middle.
std::pair<double, double> p_by_counting(std::vector<double> differences) {
  std::erase_if(differences, [](double d) { return d == 0; });
  const std::size_t n = differences.size();
  std::vector<double> sizes;
  for (const double d : differences) sizes.push_back(std::abs(d));
  const auto off = [&](auto&& is_positive) {
    double signs = -0.5 * static_cast<double>(n);
    double sum = -0.25 * static_cast<double>(n * (n + 1));
    for (std::size_t i = 0; i < n; ++i) {
      if (is_positive(i)) signs += 1, sum += rank_by_counting(sizes, i);
    }
    return std::pair(std::abs(signs), std::abs(sum));
  };
  const auto found = off([&](std::size_t i) { return differences[i] > 0; });
  double signs = 0, sums = 0;
  for (std::size_t bits = 0; bits < std::size_t{1} << n; ++bits) {
    const auto [by_sign, by_sum] = off([&](std::size_t i) { return (bits >> i & 1U) != 0; });
    signs += by_sign >= found.first ? 1 : 0;
    sums += by_sum >= found.second ? 1 : 0;
  }
  return {std::ldexp(signs, -static_cast<int>(n)), std::ldexp(sums, -static_cast<int>(n))};
}

TEST(Statistics, PairedTestsAreThoseByCounting) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> few(-3, 5);  // with ties and zeros
  std::normal_distribution<double> any(0.5);
  for (int n = 0; n < 12; ++n) {
    for (const bool has_ties : {false, true}) {
      std::vector<double> differences;
      for (int i = 0; i < n; ++i) differences.push_back(has_ties ? few(random) : any(random));
      const auto [signs, sums] = p_by_counting(differences);
      EXPECT_NEAR(app::sign_test(differences), signs, 1e-12) << n << has_ties;
      EXPECT_NEAR(app::signed_rank_test(differences), sums, 1e-12) << n << has_ties;
    }
  }
}

TEST(Statistics, ManyPairsFollowTheNormalDistribution) {
  // 200 sizes, without ties and each twice; the variance is n (n + 1) (2 n + 1) / 24, less
  // (t³ - t) / 48 for t equal ones. The largest 60 are positive.
  const double n = 200;
  for (const int twice : {1, 2}) {
    std::vector<double> differences;
    for (int i = 0; i < 200; ++i) differences.push_back((i < 140 ? -1 : 1) * (1 + i / twice));
    const double sum = (n * (n + 1) - 140 * 141) / 2, ties = twice == 2 ? 100 * 6.0 / 48 : 0;
    const double z = (sum - n * (n + 1) / 4) / std::sqrt(n * (n + 1) * (2 * n + 1) / 24 - ties);
    EXPECT_NEAR(app::signed_rank_test(differences), std::erfc(std::abs(z) / std::sqrt(2)), 1e-12);
    EXPECT_NEAR(app::sign_test(differences), 1.507061557352612e-8,
                1e-20);  // Σ C(200, k ≤ 60) / 2¹⁹⁹
  }
}

}  // namespace
}  // namespace viewgain
