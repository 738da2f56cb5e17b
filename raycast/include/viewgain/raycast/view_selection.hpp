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

/// By what GainEvaluator::best() chooses.
struct VIEWGAIN_EXPORT BestConfig {
  /// One a pose, subtracted from its gain, in the gain's unit: say for the way there. Empty: none.
  std::span<const double> costs{};
  const ViewMeasure* measure = nullptr;     ///< instead of the evaluator's gain; may be null,
  const RunMeasure* run_measure = nullptr;  ///< as may this, of which only one can be given
};

/// Views chosen from a batch of poses; see GainEvaluator::best().
struct VIEWGAIN_EXPORT BestViews {
  std::vector<std::size_t> indices;  ///< into the poses, best first
  std::vector<ViewGain> gains;       ///< of those, as evaluate() has them; empty with a measure
  /// Of each of them: the gain, or the measure, less the cost, in the gain's unit.
  std::vector<double> worth;
  bool complete = true;  ///< false: a stop was requested, and this is the best of those scored
};

/// Views chosen by GainEvaluator::race(), and what that took.
struct VIEWGAIN_EXPORT RacedViews : BestViews {
  std::vector<std::size_t> scored_indices;  ///< poses that were scored in full, ascending
  std::vector<ViewGain> scored_gains;       ///< of those; empty with a measure
  std::uint64_t rays_traced = 0;            ///< of both stages
};

/// What GainEvaluator::race() chooses by.
struct VIEWGAIN_EXPORT RaceConfig {
  std::uint64_t seed = 1;                ///< which rays the first stage takes, by the paper's gain
  std::span<const double> costs{};       ///< as BestConfig::costs
  const ViewMeasure* measure = nullptr;  ///< instead of the evaluator's gain; may be null,
  const RunMeasure* run_measure = nullptr;  ///< as may this, of which only one can be given
};

/// Views that are good together, in the order of their choice; see GainEvaluator::best_set().
struct VIEWGAIN_EXPORT ViewSet {
  std::vector<std::size_t> indices;  ///< into the poses, in the order of their choice
  std::vector<ViewGain> marginal;    ///< of those: what each adds to the ones before it
  double gain = 0;                   ///< of all together [nat, m² for trace]
  std::size_t evaluations = 0;       ///< of single poses
  bool complete = true;              ///< false: a stop was requested before the last choice
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
