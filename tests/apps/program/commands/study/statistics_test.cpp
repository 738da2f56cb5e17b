// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "program/commands/study/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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

TEST(Statistics, RanksAreThoseByCounting) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> few(0, 5);
  std::size_t cases = 0;
  for (int size = 0; size < 40; ++size) {
    std::vector<double> values;
    for (int i = 0; i < size; ++i) values.push_back(few(random));
    const std::vector<double> found = app::ranks(values);
    ASSERT_EQ(found.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i, ++cases) {
      EXPECT_EQ(found[i], rank_by_counting(values, i));
    }
  }
  EXPECT_EQ(cases, 780U);
}

TEST(Statistics, SpearmanInClosedForm) {
  // Without ties it is 1 - 6 Σd² / (n (n² - 1)).
  std::mt19937 random(5);
  for (int n = 2; n < 30; ++n) {
    std::vector<double> a, b;
    for (int i = 0; i < n; ++i) a.push_back(i), b.push_back(std::exp(0.1 * i));
    std::shuffle(b.begin(), b.end(), random);
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double d = rank_by_counting(a, i) - rank_by_counting(b, i);
      squares += d * d;
    }
    EXPECT_NEAR(app::spearman(a, b), 1 - 6 * squares / (n * (n * n - 1.0)), 1e-12);
    EXPECT_NEAR(app::spearman(a, a), 1, 1e-12);
  }
  // Places 1, 2.5, 2.5, 4 against 1..4: 4.5 / sqrt(4.5 * 5).
  EXPECT_NEAR(app::spearman(std::vector<double>{0, 1, 1, 7}, std::vector<double>{1, 2, 3, 4}),
              std::sqrt(0.9), 1e-12);
}

TEST(Statistics, WhatSaysNothingHasNoCorrelation) {
  EXPECT_TRUE(std::isnan(app::spearman({}, {})));
  EXPECT_TRUE(std::isnan(app::spearman(std::vector<double>{1}, std::vector<double>{2})));
  EXPECT_TRUE(std::isnan(app::spearman(std::vector<double>{1, 2}, std::vector<double>{2, 2})));
  // Pairs with a NaN are left out.
  EXPECT_NEAR(app::spearman(std::vector<double>{1, kNaN, 2, 3}, std::vector<double>{3, 9, kNaN, 1}),
              -1, 1e-12);
}

TEST(Statistics, MeanAndItsError) {
  const app::MeanWithError mean = app::mean_of(std::vector<double>{1, 2, kNaN, 3, 6});
  EXPECT_EQ(mean.count, 4U);
  EXPECT_DOUBLE_EQ(mean.mean, 3);
  EXPECT_DOUBLE_EQ(mean.error, std::sqrt(14.0 / 3 / 4));
  EXPECT_TRUE(std::isnan(app::mean_of(std::vector<double>{5}).error));
  EXPECT_TRUE(std::isnan(app::mean_of({}).mean));
}

}  // namespace
}  // namespace viewgain
