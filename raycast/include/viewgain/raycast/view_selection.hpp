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
  /// Cost of each pose, for example of the path to it. Subtracted from the pose's gain, in the
  /// gain's unit. Empty: none.
  std::span<const double> costs{};
  const ViewMeasure* measure = nullptr;  ///< custom gain that replaces the evaluator's, or null
  /// Custom gain that sees all voxels that rays pass, or null. Only one of the two measures may be
  /// set.
  const RunMeasure* run_measure = nullptr;
  /// Time limit [s] from the start of the call. The call then finishes its current views and
  /// returns the best result so far. At most half of the time goes to the first stage. Infinity:
  /// none.
  double deadline = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 1;  ///< selects the rays of race()'s first stage, with the paper's gain
};

/// Views chosen from a batch of poses, with statistics; see GainEvaluator::best() and race().
struct VIEWGAIN_EXPORT BestViews {
  std::vector<std::size_t> indices;  ///< into the poses, best first; only poses scored in full
  std::vector<ViewGain> gains;  ///< results of evaluate() for these poses; empty with a measure
  /// Gain (or measure) minus cost of each of these poses, in the gain's unit.
  std::vector<double> worth;
  /// False: a stop or the deadline ended the call early.
  bool complete = true;
  std::size_t estimated = 0;                ///< number of poses scored with only some of their rays
  std::vector<std::size_t> scored_indices;  ///< poses that were scored in full, ascending
  std::vector<ViewGain> scored_gains;       ///< results of these poses; empty with a measure
  /// Number of rays of both stages, including those of invalid poses.
  std::uint64_t rays_traced = 0;
};

/// A set of views with a large gain together, in the order chosen; see GainEvaluator::best_set().
struct VIEWGAIN_EXPORT ViewSet {
  std::vector<std::size_t> indices;  ///< into the poses, in the order chosen
  std::vector<ViewGain> marginal;    ///< marginal gains: the increase over the earlier views
  double gain = 0;                   ///< gain of the set, in the gain's unit
  /// Lower bound of `gain`. Each hazard cell (HazardField) counts only for the view that gains most
  /// from it, because one unknown object can hide the cell from several views. Equal to `gain` for
  /// the paper's gain.
  double gain_by_best_alone = 0;
  std::size_t evaluations = 0;  ///< number of evaluations of single poses
  bool complete = true;         ///< false: a stop was requested before the last choice
};

/// Sampling of GainEvaluator::approximate().
struct VIEWGAIN_EXPORT ApproximateConfig {
  double share = 0.1;      ///< largest share of a view's rays to trace, in (0, 1]
  std::uint64_t seed = 1;  ///< selects the rays
};

/// An estimated gain, in the gain's unit.
struct VIEWGAIN_EXPORT ApproximateGain {
  double gain = std::numeric_limits<double>::quiet_NaN();  ///< the estimate
  /// Standard error, in the same unit.
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  std::uint32_t rays = 0;  ///< number of traced rays
};

}  // namespace viewgain
