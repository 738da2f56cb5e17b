// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "viewgain/core/criterion.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

/// Sets the rules of gain (`stop_gain` [nat, m² for trace]) and area (`stop_area`, a share of the
/// surface) by which a run ends that chooses by this gain; what is not given has its default: by
/// the paper's gain kStopGain, for trace kStopGainShare of the first decision's, and no area; by
/// the surface and the combined gain kStopArea. Throws Error(invalid_argument) for a gain below 0,
/// an area outside [0, 1), an area above 0 with the paper's gain or a gain above 0 with another,
/// and for the combined gain with the criterion trace.
VIEWGAIN_EXPORT void set_stop_rules(PlanningConfig& planning, GainModel model, Criterion criterion,
                                    std::optional<double> stop_gain,
                                    std::optional<double> stop_area);

}  // namespace viewgain
