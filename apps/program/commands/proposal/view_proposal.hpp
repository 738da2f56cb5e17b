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

/// Options for proposing and ranking views.
struct ProposalOptions {
  /// Generators, separated by commas. Empty: boundary, or a sphere if the map has no surface or
  /// views.
  std::string generator;
  std::optional<std::size_t> count{};
  std::optional<double> distance{};
  std::string center;
  std::string reach;
  std::string body;
  std::optional<double> support_plane{};
  std::vector<std::string> obstacles;
  std::string poses;  ///< file of candidates, which replace the default generator
  CostOptions costs;  ///< costs of these candidates, and of the path
  std::string plan = "1";
  std::string gain = default_gain();
  std::string hazard;
  std::uint64_t seed = 1;
};

/// Adds the flags.
void add_next_view_options(App& app, ProposalOptions& options);

/// Throws Error(invalid_argument), naming the flag, also for flags that the generator or the gain
/// would silently ignore.
void check(const ProposalOptions& options);

/// The sensor with --body.
[[nodiscard]] Sensor with_body(Sensor sensor, const ProposalOptions& options);

/// The model of a map with --obstacle (obstacles_of()) and --hazard.
[[nodiscard]] SurfaceModel model_of(BeliefGrid grid, const Sensor& sensor,
                                    const ProposalOptions& options, Obstacles obstacles,
                                    const ExecConfig& exec);

/// Settings of the generation. `map`: its name in messages, or empty if its views are still to
/// come; `tried`: poses of failed views. Throws Error(invalid_argument) if boundaries are requested
/// for a map without views. Also throws whatever read_reach_toml() throws.
[[nodiscard]] GenerationConfig generation_config(const ProposalOptions& options,
                                                 const Sensor& sensor, const BeliefGrid& grid,
                                                 const std::string& map,
                                                 const std::vector<Pose>& tried = {});

/// Evaluator of --gain on the model's scene.
[[nodiscard]] GainEvaluator evaluator_of(const ProposalOptions& options, const SurfaceModel& model,
                                         const Sensor& sensor, const ExecConfig& exec);

/// Warns of implausible numbers of sensor and flags (set_up_warnings.hpp).
void warn_of_set_up(const ProposalOptions& options, const Obstacles& obstacles,
                    const BeliefGrid& grid, const Sensor& sensor, bool frames_follow = false);
/// Warns of views of the map inside obstacles, and of --poses that do not see the map.
void warn_of_views(const ProposalOptions& options, const Obstacles& obstacles,
                   const SurfaceModel& model, const Sensor& sensor);

/// At most `top` candidates ranked together (rank_views()), or the first views of a plan
/// (plan_views()), without views of no gain. Each has its marginal gain, and that minus --costs and
/// --cost-per-metre of the path from --from, else from `last_pose`. Throws Error(invalid_argument),
/// naming the file and the line, if there is not one cost per pose. Also throws whatever
/// begin_of_ways() throws.
[[nodiscard]] NextViews best_views(const GainEvaluator& evaluator, const Proposal& proposal,
                                   const ProposalOptions& options,
                                   const std::optional<Pose>& last_pose, std::size_t top,
                                   bool quiet);

/// All candidates, each scored alone and in full, best first by gain minus cost. Throws like
/// best_views().
[[nodiscard]] NextViews all_views(const GainEvaluator& evaluator, const Proposal& proposal,
                                  const ProposalOptions& options,
                                  const std::optional<Pose>& last_pose, bool quiet);

}  // namespace viewgain::app
