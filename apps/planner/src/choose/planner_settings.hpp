// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/view_planner.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::detail {

// What a planner's settings come to for its parts.

[[nodiscard]] MapModelConfig map_config(const PlannerConfig& config);
[[nodiscard]] ProposerConfig proposer_config(const PlannerConfig& config, const Sensor& sensor);
/// Throws as set_stop_rules().
[[nodiscard]] PlanningConfig planning_config(const PlannerConfig& config);

}  // namespace viewgain::detail
