// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/rank_views.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

std::vector<double> view_costs(std::span<const Pose> poses, const RankConfig& config,
                               const std::optional<Eigen::Vector3d>& here) {
  if (!std::isfinite(config.cost_per_metre) || config.cost_per_metre < 0) {
    throw Error(ErrorCode::invalid_argument, "cost_per_metre " + short_text(config.cost_per_metre) +
                                                 " must be at least 0 and finite");
  }
  std::vector<double> costs(config.costs.begin(), config.costs.end());
  if (config.cost_per_metre == 0 || !here) return costs;
  if (costs.empty()) costs.resize(poses.size());
  if (costs.size() != poses.size()) return costs;  // best() refuses them
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double way = (poses[i].translation() - *here).norm();
    // A bad pose is last whatever the way to it.
    if (std::isfinite(way)) costs[i] += config.cost_per_metre * way;
  }
  return costs;
}

Ranking rank_views(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                   std::size_t k, const RankConfig& config,
                   const std::optional<Eigen::Vector3d>& here, const BatchControl& control) {
  const std::vector<double> costs = view_costs(T_world_camera, config, here);
  const BestConfig best_by{
      .costs = costs, .measure = config.measure, .run_measure = config.run_measure};
  // Of all of them where all are scored, since the rule of area asks for the most that any
  // promises.
  BestViews best =
      config.exact || evaluator.model() == GainModel::paper
          ? evaluator.best(T_world_camera, T_world_camera.size(), best_by, control)
          : evaluator.race(T_world_camera, std::max<std::size_t>(k, 1), best_by, control);
  Ranking ranking;
  ranking.complete = best.complete;
  const std::size_t wanted = std::min(best.indices.size(), k);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t at = best.indices[i];
    ranking.views.push_back(
        {at, T_world_camera[at], best.gains.empty() ? ViewGain{} : best.gains[i], best.worth[i]});
  }
  if (!best.scored_gains.empty()) ranking.scored_indices = std::move(best.scored_indices);
  ranking.scored_gains = std::move(best.scored_gains);
  return ranking;
}

void leave_out_gainless(Ranking& ranking, const RankConfig& config) {
  if (config.measure != nullptr || config.run_measure != nullptr) return;
  std::erase_if(ranking.views, [](const RankedView& view) { return !(view.gain.gain > 0); });
}

}  // namespace viewgain
