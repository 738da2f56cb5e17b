// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/rank_views.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/core/tour.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/raycast/view_tour.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kMostPlanned = 1000;
// Sampling for views ranked together: fraction of rays, and minimum number of poses in total and
// per stop.
constexpr double kFewRays = 0.25;
constexpr std::size_t kByStop = 3, kFewPoses = 32;

void refuse_measures(const RankConfig& config) {
  if (config.measure == nullptr && config.run_measure == nullptr) return;
  refuse("measure and run_measure cannot be used to choose a set of views");
}

double least_area_of(const PlanAhead& ahead, double surface_area) {
  return ahead.least_share * std::fmax(surface_area, 0);
}

bool has_costs(const RankConfig& config) {
  return !config.costs.empty() || config.cost_per_metre > 0;
}

std::optional<Eigen::Vector3d> begin_of_ways(const RankConfig& config) {
  if (!config.current_pose) return std::nullopt;
  if (!rigid_pose(*config.current_pose)) {
    refuse("current_pose is not a rigid transform of finite numbers");
  }
  return config.current_pose->translation();
}

// In the order of the tour.
Ranking ranking_of(ViewTour tour, std::span<const Pose> T_world_camera) {
  Ranking ranking;
  ranking.complete = tour.set.complete;
  for (const std::size_t place : tour.tour.stops) {
    const std::size_t at = tour.set.indices[place];
    ranking.views.push_back({at, T_world_camera[at], tour.set.marginal[place], tour.worth[place]});
  }
  for (std::size_t i = 0; i < tour.alone.size(); ++i) {
    if (std::isnan(tour.alone[i].gain)) continue;
    ranking.scored_indices.push_back(i);
    ranking.scored_gains.push_back(tour.alone[i]);
  }
  ranking.way = tour.tour.cost;
  return ranking;
}

// Scores the views that were chosen with few rays in full, each alone.
void score_in_full(const GainEvaluator& evaluator, Ranking& ranking) {
  std::vector<std::size_t>& indices = ranking.scored_indices;
  indices.clear();
  std::vector<Pose> poses;
  for (const RankedView& view : ranking.views) indices.push_back(view.index);
  std::sort(indices.begin(), indices.end());
  for (const std::size_t index : indices) {
    const auto at = std::find_if(ranking.views.begin(), ranking.views.end(),
                                 [&](const RankedView& view) { return view.index == index; });
    poses.push_back(at->T_world_camera);
  }
  ranking.scored_gains = evaluator.evaluate(poses);
}

// Unless results must be exact, uses few poses with some of their rays.
Ranking chosen_together(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                        TourConfig tour, bool exact, const BatchControl& control) {
  if (!exact) {
    tour.max_candidates = std::max(kFewPoses, kByStop * tour.max_stops);
    tour.share = kFewRays;
  }
  Ranking ranking = ranking_of(plan_tour(evaluator, T_world_camera, tour, control), T_world_camera);
  if (!exact) score_in_full(evaluator, ranking);
  return ranking;
}

// A set without paths. Its first view is the best single one, even if others are estimates.
Ranking set_of(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera, std::size_t k,
               const std::vector<double>& costs, bool exact, const BatchControl& control) {
  TourConfig tour{.max_stops = k, .costs = costs};
  if (exact) return chosen_together(evaluator, T_world_camera, tour, exact, control);
  const BestViews best = evaluator.race(T_world_camera, 1, {.costs = costs}, control);
  if (!best.complete || best.indices.empty() || !(best.gains.front().gain > 0)) {
    Ranking none;
    none.complete = best.complete;
    return none;
  }
  tour.first = best.indices.front();
  Ranking chosen = chosen_together(evaluator, T_world_camera, tour, exact, control);
  if (chosen.views.empty()) return chosen;  // stopped
  chosen.views.front().gain = best.gains.front();
  chosen.views.front().worth = best.worth.front();
  return chosen;
}

}  // namespace

void PlanAhead::check() const {
  if (plan < 1 || plan > kMostPlanned) {
    refuse("plan must be in 1.." + std::to_string(kMostPlanned) + ", not " + std::to_string(plan));
  }
  if (take < 1 || take > plan) {
    refuse("take must be in 1.." + std::to_string(plan) + " (plan), not " + std::to_string(take));
  }
  if (!(least_share >= 0 && least_share < 1)) {
    refuse("least_share must be at least 0 and less than 1, not " + short_text(least_share));
  }
}

std::vector<double> view_costs(std::span<const Pose> poses, const RankConfig& config) {
  if (!std::isfinite(config.cost_per_metre) || config.cost_per_metre < 0) {
    refuse("cost_per_metre must be at least 0 and finite, not " +
           short_text(config.cost_per_metre));
  }
  const std::optional<Eigen::Vector3d> here = begin_of_ways(config);
  std::vector<double> costs(config.costs.begin(), config.costs.end());
  if (config.cost_per_metre == 0 || !here) return costs;
  if (costs.empty()) costs.resize(poses.size());
  if (costs.size() != poses.size()) return costs;  // best() rejects them
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d to = poses[i].translation() - *here;
    const double way = std::hypot(to.x(), to.y(), to.z());  // finite at any distance
    // An invalid pose is omitted regardless of its path.
    if (std::isfinite(way)) costs[i] += config.cost_per_metre * way;
  }
  return costs;
}

Ranking rank_views(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                   std::size_t k, const RankConfig& config, const BatchControl& control) {
  const std::vector<double> costs = view_costs(T_world_camera, config);
  if (config.together) {
    refuse_measures(config);
    Ranking chosen = set_of(evaluator, T_world_camera, k, costs, config.exact, control);
    if (!chosen.views.empty() && has_costs(config)) chosen.worth = chosen.views.front().worth;
    if (!chosen.views.empty() || !chosen.complete) return chosen;
  }
  const BestConfig best_by{
      .costs = costs, .measure = config.measure, .run_measure = config.run_measure};
  // If all poses are scored, the stop rule for area uses the largest expected area of them all.
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
  if (has_costs(config) && !ranking.views.empty()) ranking.worth = ranking.views.front().worth;
  return ranking;
}

Ranking plan_views(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                   const PlanAhead& ahead, double surface_area, const RankConfig& config,
                   const BatchControl& control) {
  ahead.check();
  refuse_measures(config);
  const std::optional<Eigen::Vector3d> here = begin_of_ways(config);
  const Pose start = here ? Pose(Eigen::Matrix3d::Identity(), *here) : Pose();
  TourConfig tour{.max_stops = ahead.plan,
                  .way = straight_ways(start, T_world_camera),
                  .cost_per_way = config.cost_per_metre,
                  .costs = config.costs,
                  .least_area = least_area_of(ahead, surface_area)};
  if (!here) {
    tour.way = [between = std::move(tour.way)](std::size_t from, std::size_t to) {
      return from == kTourStart ? 0.0 : between(from, to);
    };
  }
  Ranking planned =
      chosen_together(evaluator, T_world_camera, std::move(tour), config.exact, control);
  if (has_costs(config)) {
    planned.worth = 0;
    for (const RankedView& view : planned.views) planned.worth += view.worth;
  }
  if (!planned.views.empty() || !planned.complete) return planned;
  return rank_views(evaluator, T_world_camera, 1, config, control);
}

void keep_worth(const GainEvaluator& evaluator, const PlanAhead& ahead, double surface_area,
                Proposal& planned) {
  const std::vector<ViewGain> gains = evaluator.evaluate(poses_of(planned.candidates));
  const double least = least_area_of(ahead, surface_area);
  std::vector<Candidate> kept;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const bool is_little = !(gains[i].gain > 0) || gains[i].area < least;
    if (!is_little) kept.push_back(std::move(planned.candidates[i]));
  }
  planned.candidates = std::move(kept);
}

Ranking rank_in_turn(const GainEvaluator& evaluator, std::span<const Pose> T_world_camera,
                     RankConfig config, const BatchControl& control) {
  refuse_measures(config);
  config.exact = true;
  config.together = false;
  Ranking ranking = rank_views(evaluator, T_world_camera, T_world_camera.size(), config, control);
  ranking.worth = std::numeric_limits<double>::quiet_NaN();
  std::sort(ranking.views.begin(), ranking.views.end(),
            [](const RankedView& a, const RankedView& b) { return a.index < b.index; });
  return ranking;
}

std::optional<DecisionMaking::Decision> decision_of(const Ranking& ranking, GainModel model) {
  if (ranking.views.empty()) return std::nullopt;
  const RankedView& first = ranking.views.front();
  const auto& indices = ranking.scored_indices;
  const auto scored = std::lower_bound(indices.begin(), indices.end(), first.index);
  const ViewGain& gain =
      scored == indices.end()
          ? first.gain
          : ranking.scored_gains[static_cast<std::size_t>(scored - indices.begin())];
  DecisionMaking::Decision decision;
  decision.candidate = first.index;
  decision.gain = gain.gain;
  decision.area = gain.area;
  decision.worth = ranking.worth;
  if (std::isnan(gain.gain)) return decision;  // invalid poses, or a custom measure
  if (model == GainModel::paper) {
    const std::uint32_t touched = gain.unknown_voxels + gain.occupied_voxels;
    decision.gain_per_voxel = touched > 0 ? gain.gain / touched : 0.0;
  } else {
    decision.best_area = 0;
    for (const ViewGain& of : ranking.scored_gains) {
      decision.best_area = std::fmax(decision.best_area, of.area);
    }
  }
  return decision;
}

void leave_out_gainless(Ranking& ranking, const RankConfig& config) {
  if (config.measure != nullptr || config.run_measure != nullptr) return;
  std::erase_if(ranking.views, [](const RankedView& view) { return !(view.gain.gain > 0); });
}

}  // namespace viewgain
