// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

/// @file
/// Ranking of views by gain minus costs, for the planner, studies and the commands `next`, `model`
/// and `reconstruct`. Poses are T_world_camera.

namespace viewgain {

/// Settings of the ranking.
struct VIEWGAIN_EXPORT RankConfig {
  /// Cost of each pose, subtracted from its gain, in the gain's unit. Empty: none.
  std::span<const double> costs{};
  /// Cost per metre of the straight path from `current_pose`, also subtracted from the gain. The
  /// combined gain of a square metre of new surface is proportional to 1 / voxel_size². Scale this
  /// cost with 1 / voxel_size² as well.
  double cost_per_metre = 0;
  /// Current camera pose, T_world_camera; only its centre is used. If it is empty,
  /// ViewPlanner::rank() uses the planner's last pose, and the functions of this file ignore paths.
  std::optional<Pose> current_pose{};
  const ViewMeasure* measure = nullptr;     ///< custom gain, as in BestConfig
  const RunMeasure* run_measure = nullptr;  ///< custom gain, as in BestConfig
  /// Ranks each view by its marginal gain given the higher-ranked views, so that views do not show
  /// the same surface twice. Cannot be used with measures.
  bool together = false;
  /// True: scores all poses in full. False: uses two stages (GainEvaluator::race()), except with
  /// the paper's gain. If `together` is set and `exact` is not, each view after the first is chosen
  /// from at least 32 poses, by tracing a quarter of their rays. Its marginal gain is an estimate.
  bool exact = false;
};

/// Planning ahead: K views are planned together, with a short path through them, and M of them are
/// taken before replanning. K = M = 1 plans one view at a time, M = 1 is a receding horizon, and M
/// = K takes the whole plan. After each frame, planned views that became impossible or no longer
/// have enough expected new surface are dropped. If none is left, the planner replans.
struct VIEWGAIN_EXPORT PlanAhead {
  std::size_t plan = 1;  ///< K
  std::size_t take = 1;  ///< M
  /// Minimum expected new surface of a planned view, as a fraction of the surface so far. With the
  /// paper's gain any positive gain suffices.
  double least_share = kStopArea;

  /// Whether more than one view is planned.
  [[nodiscard]] bool is_on() const noexcept { return plan > 1; }
  /// Throws Error(invalid_argument) unless 1 <= take <= plan <= 1000 and the share is in [0, 1).
  void check() const;
};

/// Generator name of candidates that remain from an earlier plan.
inline constexpr std::string_view kPlanned = "plan";

/// One of the best views.
struct VIEWGAIN_EXPORT RankedView {
  std::size_t index = 0;  ///< index of the candidate in the proposal, or of the given pose
  Pose T_world_camera;    ///< camera pose
  ViewGain gain;          ///< all NaN with a measure; marginal gain if views are ranked together
  double worth = 0;       ///< gain or measure, minus the cost, in the gain's unit
};

/// The best views.
struct VIEWGAIN_EXPORT Ranking {
  std::vector<RankedView> views;  ///< best first
  bool complete = true;           ///< false: stopped early
  /// Indices of the views that were scored in full: all views or, with two stages, those of the
  /// second stage. Empty with a measure.
  std::vector<std::size_t> scored_indices{};
  std::vector<ViewGain> scored_gains{};  ///< their gains, in the same order
  double way = 0;                        ///< straight-line path through the views of a plan [m]
  /// Gain minus costs, in the gain's unit. It refers to the first view or, for a new plan, to all
  /// of its views. NaN if there are no costs, or if the views remain from an earlier plan
  /// (rank_in_turn()).
  double worth = std::numeric_limits<double>::quiet_NaN();
};

/// Cost of each pose under `config`, including the path from current_pose. Empty if there are no
/// costs. Throws Error(invalid_argument) for a cost_per_metre that is negative or not finite, and
/// for a current_pose that is not rigid to within 1e-3.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<double> view_costs(std::span<const Pose> T_world_camera,
                                                             const RankConfig& config);

/// The k best poses, k >= 1. Feasibility is not checked. Ties go to the earlier pose. Invalid poses
/// are omitted and, if config.together is set, poses without marginal gain as well. Throws whatever
/// view_costs() and GainEvaluator::best() throw.
[[nodiscard]] VIEWGAIN_EXPORT Ranking rank_views(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 std::size_t k, const RankConfig& config,
                                                 const BatchControl& control = {});

/// Chooses at most `ahead.plan` poses whose joint gain is large. They are ordered along a short
/// path of straight lines. The path starts at config.current_pose or, if that is empty, anywhere.
/// Paths cost config.cost_per_metre; see plan_tour(). `surface_area` [m²] is the surface so far,
/// for PlanAhead::least_share. Poses must be finite. Throws Error(invalid_argument) if a
/// measure is set. Also throws whatever PlanAhead::check(), view_costs() and plan_tour() throw.
[[nodiscard]] VIEWGAIN_EXPORT Ranking plan_views(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 const PlanAhead& ahead, double surface_area,
                                                 const RankConfig& config,
                                                 const BatchControl& control = {});

/// Removes the views of a plan whose expected new surface on the current map is too small.
/// `surface_area` as in plan_views().
VIEWGAIN_EXPORT void keep_worth(const GainEvaluator& evaluator, const PlanAhead& ahead,
                                double surface_area, Proposal& planned);

/// Scores the views that remain from an earlier plan, each on its own, and keeps their order.
/// Throws whatever plan_views() throws.
[[nodiscard]] VIEWGAIN_EXPORT Ranking rank_in_turn(const GainEvaluator& evaluator,
                                                   std::span<const Pose> T_world_camera,
                                                   RankConfig config,
                                                   const BatchControl& control = {});

/// The values of a ranking that the stopping rules use, such as the gain and the area of its first
/// view. Empty if the ranking has no views.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<DecisionMaking::Decision> decision_of(
    const Ranking& ranking, GainModel model);

/// Removes the views without gain, unless a custom measure ranked them.
VIEWGAIN_EXPORT void leave_out_gainless(Ranking& ranking, const RankConfig& config);

}  // namespace viewgain
