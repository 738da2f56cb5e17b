// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "program/commands/reconstruct/run.hpp"

namespace viewgain::app {

/// What a candidate was said to bring, and what it truly brings.
struct CandidateOutcome {
  Candidate candidate;
  double score;            ///< by what the policy ranks by; its unit
  double predicted_area;   ///< new surface to be expected [m²]; NaN where the gain does not say
  double new_samples;      ///< of the mesh, that the map's points cover afterwards and not before
  double new_area;         ///< what these stand for [m²]
  double entropy_removed;  ///< by the view, in the map's criterion
};

/// How well a policy's score of candidates tells what they bring.
struct PredictionQuality {
  std::size_t view = 0;         ///< after so many views
  double spearman_area = 0;     ///< of the score with the truly new samples
  double spearman_entropy = 0;  ///< of the score with the entropy removed
  double top1_share = 0;        ///< new samples of the favourite / of the best candidate; NaN
                                ///< where no score is above another
  std::vector<CandidateOutcome> outcomes;
};

/// Simulates candidates for the next view without noise, one frame each into a copy of the map, and
/// holds what comes of it against the policy's scores: half of `count` from the proposal, evenly
/// taken from its list, the rest feasible poses of the sphere round the object at the start's
/// distance. To be called by the loop's observer. No outcomes where the policy scores nothing, or
/// if a stop was requested. Takes some 0.1 s a candidate.
[[nodiscard]] PredictionQuality predict(Run& run, const ViewRecord& record, std::size_t count,
                                        const ExecConfig& exec, const std::stop_token& stop);

}  // namespace viewgain::app
