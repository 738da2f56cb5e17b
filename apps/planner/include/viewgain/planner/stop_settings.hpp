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
/// `stop_area`, a fraction of the surface. The paper's gain uses only stop_gain. The default is
/// kStopGain or, with criterion trace, kStopGainShare times the gain of the first decision. The
/// other gains use only stop_area; the default is kStopArea. Throws Error(invalid_argument) for a
/// gain below 0, an area outside [0, 1), a value above 0 for the rule that is not used, and for the
/// combined gain with criterion trace.
VIEWGAIN_EXPORT void set_stop_rules(PlanningConfig& planning, GainModel model, Criterion criterion,
                                    std::optional<double> stop_gain,
                                    std::optional<double> stop_area);

}  // namespace viewgain
