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
  /// This pose is chosen first, regardless of its gain and cost, unless it is invalid or its path
  /// is vetoed.
  std::optional<std::size_t> first{};
  /// Cost of the path between two poses by their indices, in a unit of your choice; kTourStart
  /// stands for the current pose. Use a motion planner's cost, or infinity to veto a path. Empty:
  /// paths are free, and stops stay in the order chosen.
  WayCost way{};
  double cost_per_way = 0;  ///< cost per unit of `way`, in the gain's unit
  /// Limit of the total path cost, in the unit of `way`; stops beyond it are not chosen.
  double budget = std::numeric_limits<double>::infinity();
  /// Chooses the view with the largest increase per path cost instead of the largest increase minus
  /// cost; for a budget of metres or seconds.
  bool per_way = false;
  std::span<const double> costs{};  ///< as BestConfig::costs: cost of each pose itself
  /// Number of candidate poses to evaluate; fewer are faster. Takes the largest gains from few
  /// rays, but no two similar poses: first poses three tenths of the working distance or 30 degrees
  /// apart, then a tenth or 15 degrees.
  std::size_t max_candidates = std::numeric_limits<std::size_t>::max();
  /// Fraction of rays to trace, in (0, 1]; values below 1 are faster and less exact, and
  /// underestimate refinement. 1 with the paper's gain.
  double share = 1;
  /// Minimum new surface [m²] of each stop after the first; ignored with the paper's gain.
  double least_area = 0;
};

/// Views that are good together, and a short path through them.
struct VIEWGAIN_EXPORT ViewTour {
  ViewSet set;  ///< in the order chosen
  /// Increase of each view when it was chosen, minus the costs of view and path.
  std::vector<double> worth;
  std::vector<ViewGain> alone;  ///< gain of each pose alone, from the same rays; NaN: not evaluated
  Tour tour;                    ///< stops are indices into `set`; its cost is that of the paths
};

/// Chooses a set greedily as best_set(), by the increase minus costs, where a view's path cost is
/// the cheapest insertion into the current tour; then order_stops() orders it. Views with no gain
/// are omitted. The first view is chosen even if it is not worth its cost, others only if they are.
/// Ignores obstacles and reach. Deterministic for any number of threads. Passes on exceptions of
/// `way`. Throws Error(invalid_argument) for a wrong number of costs, one that is not finite, a
/// share or `first` out of range, and a negative or NaN path cost or limit. Cost: best_set(), and
/// two calls of `way` per pose and stop on the calling thread.
[[nodiscard]] VIEWGAIN_EXPORT ViewTour plan_tour(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 const TourConfig& config,
                                                 const BatchControl& control = {});

}  // namespace viewgain
