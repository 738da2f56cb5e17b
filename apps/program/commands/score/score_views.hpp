// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "program/commands/score/score_options.hpp"
#include "program/commands/score/score_report.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// Scores the poses in the way that the flags ask for. `costs`: one a pose, subtracted from the
/// gains that rank; empty: none. Indices are those of `poses`.
[[nodiscard]] Scores make_scores(const ScoreOptions& options, const GainEvaluator& evaluator,
                                 const std::vector<Pose>& poses, const std::vector<double>& costs,
                                 const BatchControl& control);

}  // namespace viewgain::app
