// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "program/cli/app.hpp"
#include "viewgain/core/planning.hpp"

namespace viewgain::app {

/// Limits given by --stop; an unset optional means the default.
struct StopLimits {
  std::optional<double> gain, area, coverage;
  std::size_t idle = PlanningConfig{}.idle_views;
  std::size_t promises = PlanningConfig{}.broken_promises;
};

/// --stop RULE=LIMIT,...
void add_stop_option(App& app, std::string& text);

/// Throws Error(invalid_argument), naming the rule and, for an unknown one, the nearest.
[[nodiscard]] StopLimits stop_limits(const std::string& text);

}  // namespace viewgain::app
