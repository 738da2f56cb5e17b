// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/core/boundary_class.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// --plan K[,M].
void add_plan_option(App& app, std::string& text);
/// Throws Error(invalid_argument), naming the flag.
[[nodiscard]] PlanAhead parse_plan(const std::string& text);

/// Name of the generator for --poses.
inline constexpr const char* kGivenPoses = "poses";

/// A proposed view, and why it was proposed.
struct NextView {
  Pose T_world_camera;
  std::size_t index = 0;  ///< index of the candidate in the proposal
  ViewGain gain;          ///< marginal or individual gain, see NextViews::together
  double worth = 0;       ///< gain minus cost
  std::string generator;
  std::size_t number = 0;  ///< number among this generator's candidates, from 0
  std::optional<BoundaryClass> boundary_class{};     ///< class of the boundary that it looks beyond
  std::optional<GainEvaluator::RayOutcomes> rays{};  ///< where its rays end, from explain()
};

/// The views that a camera should take next.
struct NextViews {
  std::vector<NextView> views;  ///< best first, or in a plan's order
  std::size_t candidates = 0;   ///< number of feasible candidates; `views` are the best of them
  std::map<std::string, std::size_t> dropped;  ///< infeasible candidates: reason -> count
  GainModel model = kDefaultGain;              ///< model of the gains
  std::optional<GainEvaluator::RayOutcomes>
      no_gain{};  ///< from explain(): rays of candidates, if none has a gain
  /// Path length of a new plan, from the current camera pose [m].
  std::optional<double> plan_metres{};
  bool all_worth = true;  ///< false: some views cost more than they gain
  bool together = true;   ///< true: gains are marginal; false: individual
};

/// "3 of the views stand outside the workspace, ..." for a terminal; empty if none does.
[[nodiscard]] std::string outside_text(const NextViews& next, const BeliefGrid& grid);

/// Makes the next views from a ranking of a proposal's candidates.
[[nodiscard]] NextViews next_views(const Ranking& ranking, const Proposal& proposal,
                                   GainModel model);

/// Adds where the views' rays end. If no candidate has a gain, adds where the rays of up to 32
/// evenly chosen candidates end. Cost: two traces per view.
void explain(NextViews& next, const Proposal& proposal, const GainEvaluator& evaluator);

/// gain_model, gain_unit, candidates, dropped, next; apps/docs/reference/json.md names the keys of
/// a view.
[[nodiscard]] Json to_json(const NextViews& next);

/// Advice if most candidates were dropped for one reason; empty if there is none.
[[nodiscard]] std::string help_text(std::size_t candidates,
                                    const std::map<std::string, std::size_t>& dropped);

/// "the best of 480 views; dropped: 3 collision", and help_text().
[[nodiscard]] std::string summary_of(const NextViews& next);

/// A table for a terminal, with one line per view, and a second line if it is explained; empty
/// without views.
[[nodiscard]] std::string text_of(const NextViews& next);

[[nodiscard]] std::vector<Pose> poses_of(const NextViews& next);

}  // namespace viewgain::app
