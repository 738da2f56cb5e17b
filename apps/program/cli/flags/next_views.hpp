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

/// The generator's name of --poses.
inline constexpr const char* kGivenPoses = "poses";

/// A view worth taking, and why it was proposed.
struct NextView {
  Pose T_world_camera;
  std::size_t index = 0;  ///< of the candidate in its proposal
  ViewGain gain;          ///< NextViews::together says of what
  double worth = 0;       ///< that less its cost
  std::string generator;
  std::size_t number = 0;                            ///< among what this generator proposed, from 0
  std::optional<BoundaryClass> boundary_class{};     ///< of the boundary that it looks beyond
  std::optional<GainEvaluator::RayOutcomes> rays{};  ///< what becomes of them, by explain()
};

/// Where a camera should look next.
struct NextViews {
  std::vector<NextView> views;                 ///< best first, or in a plan's order
  std::size_t candidates = 0;                  ///< that were possible; `views` are the best of them
  std::map<std::string, std::size_t> dropped;  ///< the impossible ones: reason -> count
  GainModel model = kDefaultGain;              ///< of the gains
  std::optional<GainEvaluator::RayOutcomes>
      no_gain{};                        ///< by explain(): candidates' rays, if none gains
  std::optional<double> plan_metres{};  ///< of a new plan: its way, from where the camera is [m]
  bool all_worth = true;                ///< false: other views gain less than they cost
  bool together = true;  ///< gains are what each adds to those before; false: its own
};

/// "3 of the views stand outside the workspace, ..." for a terminal; empty where none does.
[[nodiscard]] std::string outside_text(const NextViews& next, const BeliefGrid& grid);

/// Of a ranking of a proposal's candidates.
[[nodiscard]] NextViews next_views(const Ranking& ranking, const Proposal& proposal,
                                   GainModel model);

/// Adds what becomes of the views' rays; where no candidate gains, of the rays of at most 32 of
/// them, evenly chosen. Costs two traces a view.
void explain(NextViews& next, const Proposal& proposal, const GainEvaluator& evaluator);

/// gain_model, gain_unit, candidates, dropped, next; apps/docs/reference/json.md names the keys of
/// a view.
[[nodiscard]] Json to_json(const NextViews& next);

/// What would help if most candidates were dropped for one reason; empty if nothing is known.
[[nodiscard]] std::string help_text(std::size_t candidates,
                                    const std::map<std::string, std::size_t>& dropped);

/// "the best of 480 views; dropped: 3 collision", and help_text().
[[nodiscard]] std::string summary_of(const NextViews& next);

/// A table for people, one line a view, and one more where it is explained; empty without views
/// that are not.
[[nodiscard]] std::string text_of(const NextViews& next);

[[nodiscard]] std::vector<Pose> poses_of(const NextViews& next);

}  // namespace viewgain::app
