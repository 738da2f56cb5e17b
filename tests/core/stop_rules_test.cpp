// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The rules by themselves: what they remember is all they need to go on.
#include "viewgain/support/stop_rules.hpp"

#include <gtest/gtest.h>

#include <random>

namespace viewgain {
namespace {

TEST(StopRules, GoOnFromWhatTheyRemember) {
  std::mt19937 random(5);
  const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
  const auto value = [&] { return std::uniform_real_distribution(0.0, 2.0)(random); };
  int stops = 0, steps = 0;
  for (int run = 0; run < 200; ++run) {
    PlanningConfig config;
    config.max_views = 12;
    config.idle_views = 2;
    config.stop_gain = chance(0.5) ? 0.2 : 0.05;
    config.stop_gain_is_relative = chance(0.5);
    config.stop_area = chance(0.5) ? 0.2 : 0.0;
    config.broken_promises = 2;
    StopRules whole(config), parts(config);
    ModelProgress progress{0, 1000, {}, 1.0};
    for (;;) {
      if (chance(0.8)) progress.entropy_removed += value(), progress.unknown_voxels -= 5;
      progress.new_area = chance(0.8) ? 0.1 * value() : std::numeric_limits<double>::quiet_NaN();
      DecisionMaking::Decision decision;
      decision.area = decision.gain = 0.4 * value();
      if (chance(0.7)) decision.gain_per_voxel = value();
      if (chance(0.7)) decision.best_area = 0.3 * value();
      if (chance(0.7)) decision.worth = value() - 0.1;
      const auto a = whole.after_view(progress);
      parts = StopRules(config, parts.memory());
      const auto b = parts.after_view(progress);
      ASSERT_EQ(a, b);
      parts = StopRules(config, parts.memory());
      const auto c = whole.after_decision(decision, {}, progress.surface_area);
      const auto d = parts.after_decision(decision, {}, progress.surface_area);
      ASSERT_EQ(c, d);
      ++steps;
      if (a || c) {
        ++stops;
        break;
      }
    }
  }
  EXPECT_EQ(stops, 200);
  EXPECT_GT(steps, 600);
}

}  // namespace
}  // namespace viewgain
