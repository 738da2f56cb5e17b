// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/pose_source.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// How views for a map are proposed and ranked.
struct ProposalOptions {
  /// Several with commas; empty: boundary, or a sphere where the map has no surface or views.
  std::string generator;
  std::optional<std::size_t> count{};
  std::optional<double> distance{};
  std::string center;
  std::string reach;
  std::string body;
  std::optional<double> support_plane{};
  std::vector<std::string> obstacles;
  std::string
      poses;  ///< file of candidates of the user's own; they alone unless `generator` is set
  CostOptions costs;  ///< of these, and of the way
  std::string plan = "1";
  std::string gain = default_gain();
  std::string hazard;
  std::uint64_t seed = 1;
};

/// The flags.
void add_next_view_options(App& app, ProposalOptions& options);

/// Throws Error(invalid_argument), naming the flag: also for what a generator or a gain has no use
/// for, which would be ignored in silence.
void check(const ProposalOptions& options);

/// The sensor with --body.
[[nodiscard]] Sensor with_body(Sensor sensor, const ProposalOptions& options);

/// The model of a map with --obstacle (obstacles_of()) and --hazard.
[[nodiscard]] SurfaceModel model_of(BeliefGrid grid, const Sensor& sensor,
                                    const ProposalOptions& options, Obstacles obstacles,
                                    const ExecConfig& exec);

/// Without --reach the views at boundaries stay inside of the workspace where all views so far
/// were, as in a room. `map`: what errors call it, empty for one whose views are still to come;
/// `tried`: views that brought nothing. Throws Error(invalid_argument) where boundaries are asked
/// for by name of a map without views, and as read_reach_toml().
[[nodiscard]] GenerationConfig generation_config(const ProposalOptions& options,
                                                 const Sensor& sensor, const BeliefGrid& grid,
                                                 const std::string& map,
                                                 const std::vector<Pose>& tried = {});

/// Scores views on the model's scene by --gain.
[[nodiscard]] GainEvaluator evaluator_of(const ProposalOptions& options, const SurfaceModel& model,
                                         const Sensor& sensor, const ExecConfig& exec);

/// Warns of implausible numbers of sensor and flags (set_up_warnings.hpp).
void warn_of_set_up(const ProposalOptions& options, const Obstacles& obstacles,
                    const BeliefGrid& grid, const Sensor& sensor, bool frames_follow = false);
/// Warns of views of the map inside of obstacles, and of --poses that do not see it.
void warn_of_views(const ProposalOptions& options, const Obstacles& obstacles,
                   const SurfaceModel& model, const Sensor& sensor);

/// At most `top` candidates that go together (rank_views()), or the first views of a plan
/// (plan_views()): each with what it adds to those chosen before it, and that less --costs and
/// --cost-per-metre of the way from --from, else from `last_pose`. Those that add nothing are not
/// among them. Throws Error(invalid_argument), naming the file and the line, for costs that are not
/// one a pose, and as begin_of_ways().
[[nodiscard]] NextViews best_views(const GainEvaluator& evaluator, const Proposal& proposal,
                                   const ProposalOptions& options,
                                   const std::optional<Pose>& last_pose, std::size_t top,
                                   bool quiet);

/// All candidates, each by itself and scored in full, best first by its gain less its cost. Throws
/// as best_views().
[[nodiscard]] NextViews all_views(const GainEvaluator& evaluator, const Proposal& proposal,
                                  const ProposalOptions& options,
                                  const std::optional<Pose>& last_pose, bool quiet);

}  // namespace viewgain::app
