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

/// By what plan_tour() chooses.
struct VIEWGAIN_EXPORT TourConfig {
  std::size_t max_stops = std::numeric_limits<std::size_t>::max();  ///< at most
  /// This pose is chosen first, whatever it gains and costs, unless its way is vetoed or it is bad.
  std::optional<std::size_t> first{};
  /// Between poses by their indices, kTourStart being where the camera is, in a unit of the user's
  /// own. It may price a way by what a motion planner says, or veto it: infinity. None: ways cost
  /// nothing, and stops stay in the order of their choice.
  WayCost way{};
  double cost_per_way = 0;  ///< in the gain's unit, by that of `way`
  /// Of all ways together, in the unit of `way`: stops beyond it are not chosen.
  double budget = std::numeric_limits<double>::infinity();
  /// Chosen is what adds most per way that it adds, instead of what adds most less its cost: for a
  /// budget of metres or seconds.
  bool per_way = false;
  std::span<const double> costs{};  ///< as BestConfig::costs: of each pose by itself
  /// For haste: so many poses are looked at, those of the largest gain by few rays, no two of them
  /// much alike: first those three tenths of the working distance or 30 degrees apart, then those a
  /// tenth or 15 degrees apart.
  std::size_t max_candidates = std::numeric_limits<std::size_t>::max();
  /// For haste, too: of each view's rays, evenly spread, that the choice goes by, in (0, 1]; by the
  /// paper's gain 1. Gains are estimates then, in which refinement counts for less.
  double share = 1;
  /// Stops beyond the first that add less new surface than this are not chosen [m²]; not by the
  /// paper's gain.
  double least_area = 0;
};

/// Views that are good together, and a short way through them.
struct VIEWGAIN_EXPORT ViewTour {
  ViewSet set;  ///< in the order of their choice
  /// Of each of the set: what it added when it was chosen, less what it and its way cost.
  std::vector<double> worth;
  std::vector<ViewGain> alone;  ///< one a pose: by itself, by the same rays; NaN: not looked at
  Tour tour;                    ///< its stops are places in `set`, its cost is that of the ways
};

/// A set that is greedy as best_set()'s, each choice by what a view adds to those chosen before it
/// less what it costs, its way being what it adds to that through the others where it adds least;
/// then the short order of order_stops(). What gains nothing is not chosen. The first view is
/// chosen even if it is not worth its cost, others only if they are. Costs like best_set(), and
/// calls `way` twice for every pose and stop, in the caller's thread. Obstacles and reach are not
/// looked at. The same for any number of threads. Throws Error(invalid_argument) for costs that are
/// not one a pose or not finite, a share or `first` out of range, a negative or NaN way or limit;
/// what `way` throws passes through.
[[nodiscard]] VIEWGAIN_EXPORT ViewTour plan_tour(const GainEvaluator& evaluator,
                                                 std::span<const Pose> T_world_camera,
                                                 const TourConfig& config,
                                                 const BatchControl& control = {});

}  // namespace viewgain
