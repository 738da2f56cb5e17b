// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <stop_token>
#include <vector>

#include "program/commands/reconstruct/run.hpp"
#include "viewgain/planner_mesh/policies.hpp"

namespace viewgain::app {

/// What a candidate truly brings.
struct CandidateOutcome {
  Candidate candidate;
  double new_samples;      ///< of the mesh, that the map's points cover afterwards and not before
  double new_area;         ///< what these stand for [m²]
  double entropy_removed;  ///< by the view, in the map's criterion
};

/// How well a policy's scores of candidates tell what they bring.
struct PredictionQuality {
  std::size_t policy = 0;       ///< index in the spec
  CandidateScores scores;       ///< a score and an expected area a candidate
  double spearman_area = 0;     ///< of the score with the truly new samples
  double spearman_entropy = 0;  ///< of the score with the entropy removed
  double top1_share = 0;        ///< new samples of the favourite / of the best candidate; NaN
                                ///< where no score is above another
};

/// What is said of the candidates for a view, and what they bring.
struct Prediction {
  std::size_t view = 0;  ///< after so many views
  std::vector<CandidateOutcome> outcomes;
  std::vector<PredictionQuality> by_policy;  ///< of those that score views
};

/// What ranks by each policy, by its index in the spec.
using Scorers = std::map<std::size_t, PolicyDecision>;

/// Simulates candidates for the next view without noise, one frame each into a copy of the map, and
/// holds what comes of it against the scores: half of `count` from the run's proposal, evenly taken
/// from its list, the rest feasible poses of the sphere round the object at the start's distance.
/// To be called by the loop's observer. Empty where no policy scores anything, or if a stop was
/// requested. Takes some 0.1 s a candidate.
[[nodiscard]] Prediction predict(Run& run, const ViewRecord& record, Scorers& scorers,
                                 std::size_t count, const ExecConfig& exec,
                                 const std::stop_token& stop);

}  // namespace viewgain::app
