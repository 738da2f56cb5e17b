// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/score/score_views.hpp"

#include <cstddef>
#include <numeric>
#include <utility>

namespace viewgain::app {
namespace {

// The gains less the costs, where there are any.
std::vector<std::size_t> best_by_worth(std::vector<ViewGain> gains,
                                       const std::vector<double>& costs, std::size_t k) {
  for (std::size_t i = 0; i < costs.size(); ++i) gains[i].gain -= costs[i];
  return best_indices(gains, k);
}

Scores scored(const ScoreOptions& options, const GainEvaluator& evaluator,
              const std::vector<Pose>& poses, const std::vector<double>& costs,
              const BatchControl& control) {
  Scores scores;
  scores.scored.gains.resize(poses.size());
  evaluator.evaluate(poses, scores.scored.gains, control);
  scores.scored.indices.resize(poses.size());
  std::iota(scores.scored.indices.begin(), scores.scored.indices.end(), std::size_t{0});
  scores.best.indices = best_by_worth(scores.scored.gains, costs, options.top);
  for (const std::size_t i : scores.best.indices) {
    scores.best.gains.push_back(scores.scored.gains[i]);
  }
  for (const ViewGain& gain : scores.scored.gains) scores.rays_traced += gain.rays;
  return scores;
}

Scores raced(const ScoreOptions& options, const GainEvaluator& evaluator,
             const std::vector<Pose>& poses, const std::vector<double>& costs,
             const BatchControl& control) {
  BestConfig config{.costs = costs, .seed = options.seed};
  config.deadline = options.deadline.value_or(config.deadline);
  BestViews views = evaluator.race(poses, options.top, config, control);
  return {.scored = {std::move(views.scored_indices), std::move(views.scored_gains)},
          .best = {std::move(views.indices), std::move(views.gains)},
          .rays_traced = views.rays_traced,
          .estimated = views.estimated};
}

Scores chosen_together(const ScoreOptions& options, const GainEvaluator& evaluator,
                       const std::vector<Pose>& poses, const BatchControl& control) {
  ViewSet set = evaluator.best_set(poses, *options.set, control);
  const ScoredViews views{std::move(set.indices), std::move(set.marginal)};
  return {.scored = views,
          .best = views,
          .set_gain = set.gain,
          .set_gain_by_best_alone = set.gain_by_best_alone,
          .rays_traced = set.evaluations * evaluator.rays_per_pose()};
}

Scores estimated(const ScoreOptions& options, const GainEvaluator& evaluator,
                 const std::vector<Pose>& poses, const std::vector<double>& costs,
                 const BatchControl& control) {
  const ApproximateConfig config{.share = *options.approximate, .seed = options.seed};
  Scores scores{.estimates = Estimates{}, .estimated = poses.size()};
  Estimates& estimates = *scores.estimates;
  estimates.gains.resize(poses.size());
  evaluator.approximate(poses, estimates.gains, config, control);
  std::vector<ViewGain> ranked(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ranked[i].gain = estimates.gains[i].gain;
    scores.rays_traced += estimates.gains[i].rays;
  }
  estimates.best = best_by_worth(std::move(ranked), costs, options.top);
  return scores;
}

}  // namespace

Scores make_scores(const ScoreOptions& options, const GainEvaluator& evaluator,
                   const std::vector<Pose>& poses, const std::vector<double>& costs,
                   const BatchControl& control) {
  if (options.race) return raced(options, evaluator, poses, costs, control);
  if (options.set) return chosen_together(options, evaluator, poses, control);
  if (options.approximate) return estimated(options, evaluator, poses, costs, control);
  return scored(options, evaluator, poses, costs, control);
}

}  // namespace viewgain::app
