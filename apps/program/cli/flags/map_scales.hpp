// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/json.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::app {

/// --coarsest, --fine and --finest: which scales the leaves of a map that is made get.
struct ScaleOptions {
  std::size_t coarsest = 0, finest = 0;
  std::vector<std::string> fine;

  /// Throws Error(invalid_argument) naming --fine or --finest.
  void set(IntegrationConfig& config) const;
  /// For a run's settings, empty where they are the defaults.
  [[nodiscard]] Json settings() const;
};

void add_scale_options(App& app, ScaleOptions& options);

}  // namespace viewgain::app
