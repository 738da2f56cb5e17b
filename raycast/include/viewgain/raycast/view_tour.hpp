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

/// Settings of plan_tour().
struct VIEWGAIN_EXPORT TourConfig {
  std::size_t max_stops = std::numeric_limits<std::size_t>::max();  ///< maximum number of views
  /// Index of the pose that is chosen first, whatever its gain and cost, unless it is invalid or
  /// its path has infinite cost.
  std::optional<std::size_t> first{};
  /// Cost of the path between two poses by their indices, in a unit of your choice; kTourStart
  /// stands for the current pose. Use a motion planner's cost, or infinity to forbid a path. Empty:
  /// paths cost nothing, and stops stay in the order chosen.
  WayCost way{};
  double cost_per_way = 0;  ///< cost per unit of `way`, in the gain's unit
  /// Limit of the total path cost, in the unit of `way`; stops beyond it are not chosen.
  double budget = std::numeric_limits<double>::infinity();
  /// Chooses the view with the largest increase of the gain per path cost, instead of the largest
  /// increase minus cost. Use it with a budget of metres or seconds.
  bool per_way = false;
  std::span<const double> costs{};  ///< as BestConfig::costs: cost of each pose itself
  /// Number of candidate poses to evaluate; fewer are faster. The poses with the largest gains are
  /// taken; the gains are estimated from few rays. Poses similar to a taken pose are skipped: those
  /// closer than 0.3 working distances and 30 degrees. If too few poses remain, only those closer
  /// than 0.1 working distances and 15 degrees are skipped.
  std::size_t max_candidates = std::numeric_limits<std::size_t>::max();
  /// Fraction of rays to trace, in (0, 1]. Values below 1 are faster and less exact, and
  /// underestimate refinement. Must be 1 with the paper's gain.
  double share = 1;
  /// Minimum new surface [m²] of each stop after the first; ignored with the paper's gain.
  double least_area = 0;
};

/// A set of views with a large gain together, and a short path through them.
struct VIEWGAIN_EXPORT ViewTour {
  ViewSet set;  ///< in the order chosen
  /// Increase of the gain by each view when it was chosen, minus the costs of view and path.
  std::vector<double> worth;
  std::vector<ViewGain> alone;  ///< gain of each pose alone, from the same rays; NaN: not evaluated
  Tour tour;                    ///< stops are indices into `set`; its cost is the sum of path costs
};

/// Chooses a set greedily like best_set(), by the increase of the gain minus costs, then orders it
/// with order_stops(). A view's path cost is that of the cheapest insertion into the current tour.
/// Views with no gain are omitted. After the first view, views that cost more than they gain are
/// omitted as well. Ignores obstacles and reach. Deterministic for any number of threads. Rethrows
/// exceptions of `way`. Throws Error(invalid_argument) naming the setting that is out of range.
/// Cost: best_set(), and two calls of `way` per pose and stop on the calling thread.
[[nodiscard]] VIEWGAIN_EXPORT ViewTour plan_tour(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 const TourConfig& config,
                                                 const BatchControl& control = {});

}  // namespace viewgain
