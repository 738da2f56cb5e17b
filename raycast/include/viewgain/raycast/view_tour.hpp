// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/tour.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/view_selection.hpp"

namespace viewgain {

/// Settings of plan_tour(). A stop is a pose that the tour visits. Gains have the evaluator's unit.
struct VIEWGAIN_EXPORT TourConfig {
  std::size_t max_stops = std::numeric_limits<std::size_t>::max();  ///< largest number of stops
  /// Index of a pose that is chosen first, whatever its gain and cost. It is ignored if the pose is
  /// invalid or its path has infinite cost.
  std::optional<std::size_t> first{};
  /// Cost of the path between two poses, given by their indices, in a unit of your choice.
  /// kTourStart stands for the current pose. Use the cost of a motion planner, or infinity to
  /// forbid a path. Empty: paths cost nothing, and stops keep the order in which they were chosen.
  WayCost way{};
  double cost_per_way = 0;  ///< cost per unit of `way`, in the gain's unit
  /// Limit of the total path cost, in the unit of `way`. Stops that would exceed it are not chosen.
  double budget = std::numeric_limits<double>::infinity();
  /// False: chooses the view with the largest marginal gain minus costs. True: divides this
  /// difference by the cost that the view adds to the path; use it with a budget.
  bool per_way = false;
  std::span<const double> costs{};  ///< cost of each pose itself, as BestConfig::costs
  /// Number of candidate poses to evaluate; fewer are faster. Takes the poses with the largest
  /// gains, estimated from few rays. Skips a pose that is closer than 0.3 working distances and 30
  /// degrees to one that it already took. If too few poses remain, the limits are 0.1 working
  /// distances and 15 degrees.
  std::size_t max_candidates = std::numeric_limits<std::size_t>::max();
  /// Fraction of rays to trace, in (0, 1]. Values below 1 are faster but less exact. They
  /// underestimate the gain from more accurate known surface. Must be 1 with the paper's gain.
  double share = 1;
  /// Minimum new surface [m²] of each stop after the first; ignored with the paper's gain.
  double least_area = 0;
};

/// A set of views with a large gain together, and a short path through them.
struct VIEWGAIN_EXPORT ViewTour {
  ViewSet set;  ///< the views, in the order in which they were chosen
  /// Marginal gain of each view of the set, minus the costs of the view and of its path, when it
  /// was chosen.
  std::vector<double> worth;
  /// Gain of each pose alone, by the rays that chose the set; NaN: not evaluated.
  std::vector<ViewGain> alone;
  Tour tour;  ///< order of the views; its stops are indices into `set`
};

/// Chooses a set of views greedily, as GainEvaluator::best_set() does, but by marginal gain minus
/// costs. Orders the set with order_stops(). The path cost of a view is that of its cheapest
/// insertion into the tour so far. Omits views with no gain and, after the first view, views that
/// cost more than they gain. Ignores obstacles and reach. Deterministic for any number of threads.
/// Rethrows exceptions of `way`. Throws Error(invalid_argument), naming the setting, if one is out
/// of range. Cost: best_set(), and two calls of `way` per pose and stop on the calling thread.
[[nodiscard]] VIEWGAIN_EXPORT ViewTour plan_tour(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 const TourConfig& config,
                                                 const BatchControl& control = {});

}  // namespace viewgain
