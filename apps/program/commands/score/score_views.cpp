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
  Ranking ranking;
  ranking.scored.gains.resize(poses.size());
  evaluator.evaluate(poses, ranking.scored.gains, control);
  ranking.scored.indices.resize(poses.size());
  std::iota(ranking.scored.indices.begin(), ranking.scored.indices.end(), std::size_t{0});
  ranking.best.indices = best_by_worth(ranking.scored.gains, costs, options.top);
  for (const std::size_t i : ranking.best.indices)
    ranking.best.gains.push_back(ranking.scored.gains[i]);
  std::uint64_t rays = 0;
  for (const ViewGain& gain : ranking.scored.gains) rays += gain.rays;
  return {std::move(ranking), rays};
}

Scores raced(const ScoreOptions& options, const GainEvaluator& evaluator,
             const std::vector<Pose>& poses, const std::vector<double>& costs,
             const BatchControl& control) {
  BestConfig config{.costs = costs, .seed = options.seed};
  config.deadline = options.deadline.value_or(config.deadline);
  BestViews views = evaluator.race(poses, options.top, config, control);
  return {Ranking{{std::move(views.scored_indices), std::move(views.scored_gains)},
                  {std::move(views.indices), std::move(views.gains)}},
          views.rays_traced, views.estimated};
}

Scores chosen_together(const ScoreOptions& options, const GainEvaluator& evaluator,
                       const std::vector<Pose>& poses, const BatchControl& control) {
  ViewSet set = evaluator.best_set(poses, *options.set, control);
  return {JointViews{{std::move(set.indices), std::move(set.marginal)}, set.gain},
          set.evaluations * evaluator.rays_per_pose()};
}

Scores estimated(const ScoreOptions& options, const GainEvaluator& evaluator,
                 const std::vector<Pose>& poses, const std::vector<double>& costs,
                 const BatchControl& control) {
  const ApproximateConfig config{.share = *options.approximate, .seed = options.seed};
  Estimates estimates;
  estimates.gains.resize(poses.size());
  evaluator.approximate(poses, estimates.gains, config, control);
  std::vector<ViewGain> ranked(poses.size());
  std::uint64_t rays = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ranked[i].gain = estimates.gains[i].gain;
    rays += estimates.gains[i].rays;
  }
  estimates.best = best_by_worth(std::move(ranked), costs, options.top);
  return {std::move(estimates), rays, poses.size()};
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
