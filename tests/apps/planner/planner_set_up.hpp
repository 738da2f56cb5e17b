// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/planner/view_planner.hpp"

namespace viewgain::test {

/// Settings of a planner and of its scorer.
struct PlannerSetUp {
  ScorerConfig map{};
  PlannerConfig planner{};

  [[nodiscard]] ViewPlanner make(const Sensor& sensor, const ExecConfig& exec = {}) const {
    return ViewPlanner(ViewScorer(sensor, map, exec), planner);
  }
  [[nodiscard]] ViewPlanner load(const std::filesystem::path& path, const Sensor& sensor,
                                 const ExecConfig& exec = {}) const {
    return ViewPlanner::load(path, sensor, map, planner, exec);
  }
};

}  // namespace viewgain::test
