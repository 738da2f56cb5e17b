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
/// Which views are best, by one rule for the planner, `next`, `model`, `reconstruct` and studies
/// by a gain. `score` ranks what it is given. Poses are T_world_camera.

namespace viewgain {

/// By what views are ranked.
struct VIEWGAIN_EXPORT RankConfig {
  /// One a pose, subtracted from its gain, in the gain's unit. Empty: none.
  std::span<const double> costs{};
  /// Of the straight way from `current_pose`, likewise. The combined gain of a square metre of new
  /// surface goes with 1 / voxel², so a cost per metre does, too.
  double cost_per_metre = 0;
  /// Where the camera is now, T_world_camera; only its centre is used. If it is missing,
  /// ViewPlanner::rank() uses the last pose that it was given, and the functions count no path from
  /// it.
  std::optional<Pose> current_pose{};
  const ViewMeasure* measure = nullptr;     ///< instead of the gain, as in BestConfig
  const RunMeasure* run_measure = nullptr;  ///< likewise
  /// The views are good together: each is ranked by what it adds to those before it, so that no two
  /// show the same (plan_tour() without ways). Not with measures.
  bool together = false;
  /// All poses are scored in full. Else, but by the paper's gain, where it is always so, by two
  /// stages: see GainEvaluator::race(). Of views that go together the first is found so; the others
  /// are chosen of few poses, 32 or more, by a quarter of their rays, and what they add is an
  /// estimate.
  bool exact = false;
};

/// How many views are planned together, in a short order, and how many of them are taken before
/// anything is decided anew: K = M = 1 one view at a time, M = 1 a receding horizon, M = K all of
/// them. After each frame views that have become impossible or that promise too little by then are
/// left out; when none is left it is planned anew.
struct VIEWGAIN_EXPORT PlanAhead {
  std::size_t plan = 1;  ///< K
  std::size_t take = 1;  ///< M
  /// A view that promises less of new surface, as a share of the surface so far, is not planned and
  /// no longer taken; by the paper's gain one that gains nothing.
  double least_share = kStopArea;

  /// Is more than one view planned?
  [[nodiscard]] bool is_on() const noexcept { return plan > 1; }
  /// Throws Error(invalid_argument) unless 1 <= take <= plan <= 1000 and the share is in [0, 1).
  void check() const;
};

/// Who proposes views of a plan that are still to be taken.
inline constexpr std::string_view kPlanned = "plan";

/// One of the best.
struct VIEWGAIN_EXPORT RankedView {
  std::size_t index = 0;  ///< of the candidate in the proposal, or of the pose that was given
  Pose T_world_camera;    ///< where the camera would be
  ViewGain gain;          ///< all NaN with a measure; what it adds if views go together
  double worth = 0;       ///< gain or measure, less the cost, in the gain's unit
};

/// The best views.
struct VIEWGAIN_EXPORT Ranking {
  std::vector<RankedView> views;  ///< best first
  bool complete = true;           ///< false: a stop was requested
  /// Those that were scored in full, by index, and their gains: all, or what the second of two
  /// stages took. Empty with a measure.
  std::vector<std::size_t> scored_indices{};
  std::vector<ViewGain> scored_gains{};  ///< of these, in their order
  double way = 0;                        ///< through the views of a plan, by straight ways [m]
  /// Of what is decided on, the first view or all of a new plan, in the gain's unit; NaN: nothing
  /// has a cost, or the views are left of a plan, which is not given up for its way.
  double worth = std::numeric_limits<double>::quiet_NaN();
};

/// What each pose costs by `config`, the way from its current_pose included; empty: nothing costs.
/// Throws Error(invalid_argument) for a cost_per_metre that is negative or not finite, and for a
/// current_pose that is not rigid (1e-3).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<double> view_costs(std::span<const Pose> T_world_camera,
                                                             const RankConfig& config);

/// The k best of the poses, at least one of them wanted, whether they are possible or not. Ties go
/// to the earlier one; bad poses are left out and, together, those that add nothing. Throws
/// Error(invalid_argument) as view_costs() and GainEvaluator::best().
[[nodiscard]] VIEWGAIN_EXPORT Ranking rank_views(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 std::size_t k, const RankConfig& config,
                                                 const BatchControl& control = {});

/// At most `ahead.plan` of the poses that are good together, in an order that is short to drive
/// from config.current_pose on by straight ways (nothing: it begins anywhere), at
/// config.cost_per_metre: plan_tour(). `surface_area` is what least_share is of [m²]. Poses must be
/// finite. Throws Error(invalid_argument) as PlanAhead::check(), with a measure, and as
/// view_costs() and plan_tour().
[[nodiscard]] VIEWGAIN_EXPORT Ranking plan_views(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 const PlanAhead& ahead, double surface_area,
                                                 const RankConfig& config,
                                                 const BatchControl& control = {});

/// Takes the views of a plan out that promise too little on the map as it is now. `surface_area` as
/// plan_views().
VIEWGAIN_EXPORT void keep_worth(const GainEvaluator& evaluator, const PlanAhead& ahead,
                                double surface_area, Proposal& planned);

/// What is left of a plan, in its order, each view with its gain by itself. Throws as plan_views().
[[nodiscard]] VIEWGAIN_EXPORT Ranking rank_in_turn(const GainEvaluator& evaluator,
                                                   std::span<const Pose> T_world_camera,
                                                   RankConfig config,
                                                   const BatchControl& control = {});

/// What the stopping rules want to know of a ranking: of its first view what that promises by
/// itself, whatever views it goes with; nothing where no view has a gain.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<DecisionMaking::Decision> decision_of(
    const Ranking& ranking, GainModel model);

/// Takes the views out that gain nothing, unless a measure of the user's own ranked them.
VIEWGAIN_EXPORT void leave_out_gainless(Ranking& ranking, const RankConfig& config);

}  // namespace viewgain
