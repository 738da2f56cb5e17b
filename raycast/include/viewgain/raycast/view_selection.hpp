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

/// By what GainEvaluator::best() and race() choose, and how long they may take.
struct VIEWGAIN_EXPORT BestConfig {
  /// One a pose, subtracted from its gain, in the gain's unit: say for the way there. Empty: none.
  std::span<const double> costs{};
  const ViewMeasure* measure = nullptr;     ///< instead of the evaluator's gain; may be null,
  const RunMeasure* run_measure = nullptr;  ///< as may this, of which only one can be given
  /// From the call on [s]: the call ends with what it has by then, at latest when the views that
  /// the threads are at are done. Half of it at most is the first stage's. Infinity: none.
  double deadline = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 1;  ///< which rays race()'s first stage takes, by the paper's gain
};

/// Views chosen from a batch of poses, and what that took; see GainEvaluator::best() and race().
struct VIEWGAIN_EXPORT BestViews {
  std::vector<std::size_t> indices;  ///< into the poses, best first; of those scored in full
  std::vector<ViewGain> gains;       ///< of those, as evaluate() has them; empty with a measure
  /// Of each of them: the gain, or the measure, less the cost, in the gain's unit.
  std::vector<double> worth;
  /// False: a stop was requested or the deadline passed before all was done.
  bool complete = true;
  std::size_t estimated = 0;                ///< poses that were scored by some of their rays
  std::vector<std::size_t> scored_indices;  ///< poses that were scored in full, ascending
  std::vector<ViewGain> scored_gains;       ///< of those; empty with a measure
  std::uint64_t rays_traced = 0;            ///< of both stages, those of bad poses among them
};

/// Views that are good together, in the order of their choice; see GainEvaluator::best_set().
struct VIEWGAIN_EXPORT ViewSet {
  std::vector<std::size_t> indices;  ///< into the poses, in the order of their choice
  std::vector<ViewGain> marginal;    ///< of those: what each adds to the ones before it
  double gain = 0;                   ///< of all together, in the gain's unit
  /// The same if a hazard cell is reached by the one of them that reaches it best alone, as views
  /// that are hindered by the same things may be: at most `gain`. By the paper's gain: `gain`.
  double gain_by_best_alone = 0;
  std::size_t evaluations = 0;  ///< of single poses
  bool complete = true;         ///< false: a stop was requested before the last choice
};

/// How GainEvaluator::approximate() samples a view.
struct VIEWGAIN_EXPORT ApproximateConfig {
  double share = 0.1;      ///< of a view's rays that are traced at most; in (0, 1]
  std::uint64_t seed = 1;  ///< which rays
};

/// An estimate of a gain, in the unit of the gain.
struct VIEWGAIN_EXPORT ApproximateGain {
  double gain = std::numeric_limits<double>::quiet_NaN();            ///< the estimate
  double standard_error = std::numeric_limits<double>::quiet_NaN();  ///< of it, in the same unit
  std::uint32_t rays = 0;                                            ///< that it is made of
};

}  // namespace viewgain
