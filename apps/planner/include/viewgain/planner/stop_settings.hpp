// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "viewgain/core/criterion.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

/// Sets the stopping rules for a run that chooses by this gain: `stop_gain` [nat, m² for trace] and
/// `stop_area`, a share of the surface. Defaults: with the paper's gain kStopGain (trace:
/// kStopGainShare of the first decision's) and no area; with the surface and combined gains
/// kStopArea. Throws Error(invalid_argument) for a gain below 0, an area outside [0, 1), an area
/// above 0 with the paper's gain or a gain above 0 with another, and for the combined gain with
/// criterion trace.
VIEWGAIN_EXPORT void set_stop_rules(PlanningConfig& planning, GainModel model, Criterion criterion,
                                    std::optional<double> stop_gain,
                                    std::optional<double> stop_area);

}  // namespace viewgain
