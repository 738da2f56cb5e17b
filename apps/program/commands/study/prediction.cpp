// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/commands/study/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "program/commands/study/statistics.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/planner_mesh/oracle_choice.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::app {
namespace {

// `count` of a list, evenly spread over it; all if there are no more.
std::vector<Candidate> evenly(const std::vector<Candidate>& from, std::size_t count) {
  if (from.size() <= count) return from;
  std::vector<Candidate> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(from[i * from.size() / count]);
  return some;
}

std::vector<Candidate> candidates_of(Run& run, const ViewRecord& record, std::size_t count) {
  // After the last view of the budget nobody has asked for a proposal.
  const std::vector<Candidate> proposed =
      record.proposal.candidates.empty()
          ? run.generation().generate(record.T_world_camera).candidates
          : record.proposal.candidates;
  std::vector<Candidate> candidates = evenly(proposed, count / 2);
  const RunSetup& setup = run.setup();
  const FeasibilityChecker checker(run.model().scene(), run.generation().config().feasibility);
  std::vector<Candidate> sphere;
  const std::vector<Pose> around = sphere_poses(2 * count, setup.distance, setup.stage.center);
  for (const Pose& pose : feasible_poses(checker, around, {}).poses) {
    sphere.push_back({pose, "sphere"});
  }
  for (Candidate& candidate : evenly(sphere, count - candidates.size())) {
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

std::vector<double> column(const std::vector<CandidateOutcome>& outcomes,
                           double CandidateOutcome::*member) {
  std::vector<double> values;
  for (const CandidateOutcome& outcome : outcomes) values.push_back(outcome.*member);
  return values;
}

}  // namespace

PredictionQuality predict(Run& run, const ViewRecord& record, std::size_t count,
                          const ExecConfig& exec, const std::stop_token& stop) {
  PredictionQuality quality;
  quality.view = record.index + 1;
  const std::vector<Candidate> candidates = candidates_of(run, record, count);
  const std::optional<CandidateScores> scores = run.decision().scores(candidates);
  if (!scores) return quality;
  const RunSetup& setup = run.setup();
  const OracleChoice oracle(run.model(), setup.sensor,
                            {setup.stage.scene, run.truth(), setup.simulation}, exec);
  const auto covered = static_cast<double>(oracle.covered());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (stop.stop_requested()) {
      quality.outcomes.clear();
      return quality;
    }
    const TrueOutcome outcome = oracle.outcome_of(candidates[i].T_world_camera);
    const double new_samples = static_cast<double>(outcome.covered) - covered;
    quality.outcomes.push_back({candidates[i], scores->score[i], scores->area[i], new_samples,
                                new_samples * run.truth()->area_per_sample(),
                                outcome.entropy_removed - record.progress.entropy_removed});
  }
  const std::vector<double> score = column(quality.outcomes, &CandidateOutcome::score),
                            added = column(quality.outcomes, &CandidateOutcome::new_samples);
  quality.spearman_area = spearman(score, added);
  quality.spearman_entropy =
      spearman(score, column(quality.outcomes, &CandidateOutcome::entropy_removed));
  // Ties go to the lower index, as in the loop; NaN is never the favourite. A score that is the
  // same for all has none.
  std::size_t favourite = 0;
  for (std::size_t i = 1; i < score.size(); ++i) {
    if (score[i] > score[favourite] || std::isnan(score[favourite])) favourite = i;
  }
  const double most = added.empty() ? 0 : *std::max_element(added.begin(), added.end());
  const bool has_favourite = std::any_of(score.begin(), score.end(), [&](double value) {
    return std::isfinite(value) && value != score[favourite];
  });
  quality.top1_share = has_favourite && most > 0 ? added[favourite] / most : std::nan("");
  return quality;
}

}  // namespace viewgain::app
