// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

struct ViewGain;
class ViewMeasure;
class RunMeasure;

/// Settings of GainEvaluator::best() and race().
struct VIEWGAIN_EXPORT BestConfig {
  /// Cost of each pose in the gain's unit, for example of the path to it. It is subtracted from the
  /// gain. Empty: none.
  std::span<const double> costs{};
  const ViewMeasure* measure = nullptr;  ///< custom gain that replaces the evaluator's; null: none
  /// Custom gain that sees all unknown voxels that rays pass; null: none. Only one of the two
  /// custom gains may be set.
  const RunMeasure* run_measure = nullptr;
  /// Time limit of the call [s]. After it, the call finishes its current views and returns the best
  /// result so far. The first stage of race() gets at most half of the time. Infinity: no limit.
  double deadline = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 1;  ///< selects the rays in the first stage of race() with the paper's gain
};

/// Views chosen from a batch of poses; see GainEvaluator::best() and race(). A pose is scored in
/// full if all its rays are traced.
struct VIEWGAIN_EXPORT BestViews {
  std::vector<std::size_t> indices;  ///< indices of the poses, best first; all are scored in full
  std::vector<ViewGain> gains;  ///< results of evaluate() for these poses; empty with a custom gain
  /// Gain minus cost of each of these poses, in the gain's unit.
  std::vector<double> worth;
  /// False: a stop or the deadline ended the call early.
  bool complete = true;
  std::size_t estimated = 0;                ///< number of poses estimated from some of their rays
  std::vector<std::size_t> scored_indices;  ///< indices of all poses scored in full, ascending
  std::vector<ViewGain> scored_gains;  ///< their results of evaluate(); empty with a custom gain
  /// Number of rays in both stages, including those of invalid poses.
  std::uint64_t rays_traced = 0;
};

/// A set of views with a large gain together; see GainEvaluator::best_set().
struct VIEWGAIN_EXPORT ViewSet {
  std::vector<std::size_t> indices;  ///< indices of poses, in the order in which they were chosen
  std::vector<ViewGain> marginal;    ///< marginal gain of each: increase of the set's gain
  double gain = 0;                   ///< gain of the set, in the gain's unit
  /// Lower bound of `gain`. Each hazard cell (HazardField) counts only for the view that gains most
  /// from it, because one unknown object can hide the cell from several views. With the paper's
  /// gain it is equal to `gain`.
  double gain_by_best_alone = 0;
  std::size_t evaluations = 0;  ///< number of times that a pose was scored
  bool complete = true;         ///< false: a stop was requested before the last choice
};

/// Settings of GainEvaluator::approximate().
struct VIEWGAIN_EXPORT ApproximateConfig {
  double share = 0.1;      ///< largest fraction of a view's rays to trace, in (0, 1]
  std::uint64_t seed = 1;  ///< selects the rays
};

/// An estimated gain.
struct VIEWGAIN_EXPORT ApproximateGain {
  double gain = std::numeric_limits<double>::quiet_NaN();  ///< estimate, in the gain's unit
  /// Standard error of the estimate, in the gain's unit.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t rays = 0;  ///< number of traced rays
};

}  // namespace viewgain
