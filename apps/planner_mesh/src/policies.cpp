// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/policies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "viewgain/core/error.hpp"
#include "viewgain/planner/hazard_views.hpp"
#include "viewgain/planner/stop_settings.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/support/mix64.hpp"
#include "viewgain/support/nearest_name.hpp"

namespace viewgain {
const std::vector<std::string>& policy_names() {
  static const std::vector<std::string> names{"gain",     "kriegel",   "sequence", "random",
                                              "frontier", "fibonacci", "oracle"};
  return names;
}

Policy parse_policy(std::string_view name) {
  return static_cast<Policy>(place_of_name(name, policy_names(), "policy"));
}

void set_stop_rules(PlanningConfig& planning, const PolicyConfig& policy,
                    std::optional<double> stop_gain, std::optional<double> stop_area) {
  const bool by_gain = policy.policy == Policy::gain && !policy.classic;
  if (!by_gain && stop_area.value_or(0) > 0) {
    throw Error(ErrorCode::invalid_argument,
                "stop_area goes with policy gain by the gains surface and combined");
  }
  if (!by_gain && stop_gain.value_or(0) > 0) {
    throw Error(ErrorCode::invalid_argument, "stop_gain goes with policy gain by the gain paper");
  }
  // A policy without a gain per voxel never asks for the rule of the paper's.
  set_stop_rules(planning, by_gain ? policy.model : GainModel::paper, policy.criterion, stop_gain,
                 stop_area);
}

PolicyDecision::PolicyDecision(const SurfaceModel& model, CandidateGeneration& generation,
                               const Sensor& sensor, const PolicyConfig& config,
                               const ExecConfig& exec)
    : model_(model),
      generation_(generation),
      sensor_(sensor),
      config_(config),
      exec_(exec),
      order_(0.5 * generation.config().boundary.estimator.patch_length) {
  config.ahead.check();
  if (config.ahead.is_on() && !is_by_gain()) {
    throw Error(ErrorCode::invalid_argument,
                "views are planned ahead by policy gain by the gains paper, surface and combined");
  }
  if (config.policy == Policy::oracle) oracle_.emplace(model, sensor, config.object, exec);
  if (config.policy == Policy::gain && config.classic) {
    classic_.emplace(model, sensor, *config.classic, exec);
  }
}

Proposal PolicyDecision::generate(const Pose& T_world_camera) {
  is_of_plan_ = false;
  if (!planned_.empty()) {
    Proposal left = generation_.propose_these({std::string(kPlanned), planned_});
    keep_worth(evaluator(), config_.ahead, mesh_area(model_.surface()), left);
    planned_ = poses_of(left.candidates);
    is_of_plan_ = !planned_.empty();
    if (is_of_plan_) return left;
  }
  return generation_.generate(T_world_camera);
}

std::optional<DecisionMaking::Decision> PolicyDecision::decide_by_gain(
    const Pose& T_world_camera, std::span<const Candidate> candidates) {
  const std::vector<Pose> poses = poses_of(candidates);
  const Eigen::Vector3d here = T_world_camera.translation();
  const GainEvaluator& by = evaluator();
  const RankConfig rank{.cost_per_metre = config_.cost_per_metre};
  if (is_of_plan_) {
    planned_.erase(planned_.begin());
    return decision_of(rank_in_turn(by, poses, rank, here), config_.model);
  }
  const Ranking ranking =
      config_.ahead.is_on()
          ? plan_views(by, poses, config_.ahead, mesh_area(model_.surface()), rank, here)
          : rank_views(by, poses, 1, rank, here);
  planned_.clear();
  for (std::size_t i = 1; i < std::min(config_.ahead.take, ranking.views.size()); ++i) {
    planned_.push_back(ranking.views[i].T_world_camera);
  }
  return decision_of(ranking, config_.model);
}

std::optional<DecisionMaking::Decision> PolicyDecision::decide(
    const Pose& T_world_camera, std::span<const Candidate> candidates) {
  if (candidates.empty()) return std::nullopt;
  if (is_by_gain()) return decide_by_gain(T_world_camera, candidates);
  const GainEvaluator& evaluator = this->evaluator();
  const bool scored = classic_ || config_.policy == Policy::frontier;
  const std::vector<ViewGain> gains = classic_ ? score_classic(candidates)
                                      : scored ? evaluator.evaluate(poses_of(candidates))
                                               : std::vector<ViewGain>(candidates.size());
  const std::optional<std::size_t> chosen = choose(T_world_camera, candidates, gains);
  if (!chosen) return std::nullopt;
  const ViewGain gain =
      scored ? gains[*chosen] : evaluator.evaluate(candidates[*chosen].T_world_camera);
  DecisionMaking::Decision decision;
  decision.candidate = *chosen;
  decision.gain = gain.gain;
  // A fixed order of views does not stop because one of them promises little.
  decision.area =
      std::isnan(gain.area) ? expected_area(candidates[*chosen].T_world_camera) : gain.area;
  return decision;
}

const GainEvaluator& PolicyDecision::evaluator() {
  if (evaluator_) {
    evaluator_ = evaluator_->with_scene(model_.scene());
  } else {
    GainConfig gain;
    gain.criterion = config_.criterion;
    // Other policies count unknown voxels, as the paper's gain does.
    gain.model = is_by_gain() ? config_.model : GainModel::paper;
    evaluator_.emplace(model_.scene(), sensor_, gain, exec_);
  }
  return *evaluator_;
}

std::vector<ViewGain> PolicyDecision::score_classic(std::span<const Candidate> candidates) {
  const bool way_counts = config_.cost_per_metre > 0;
  const std::vector<double> values = classic_->gains(poses_of(candidates), way_counts);
  std::vector<ViewGain> gains(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) gains[i].gain = values[i];
  return gains;
}

double PolicyDecision::expected_area(const Pose& T_world_camera) {
  if (area_evaluator_) {
    area_evaluator_ = area_evaluator_->with_scene(model_.scene());
  } else {
    GainConfig config;
    config.model = GainModel::surface;
    area_evaluator_.emplace(model_.scene(), sensor_, config, ExecConfig{1});
  }
  return area_evaluator_->evaluate(T_world_camera).area;
}

std::optional<std::size_t> PolicyDecision::choose(const Pose& T_world_camera,
                                                  std::span<const Candidate> candidates,
                                                  const std::vector<ViewGain>& gains) {
  const auto best_by = [&](auto&& worth) {
    std::size_t best = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double value = worth(i);
      if (value > most) most = value, best = i;  // ties to the lower index; NaN never
    }
    return best;
  };
  switch (config_.policy) {
    case Policy::gain:
      return best_by([&](std::size_t i) {
        const double distance =
            (candidates[i].T_world_camera.translation() - T_world_camera.translation()).norm();
        return gains[i].gain - config_.cost_per_metre * distance;
      });
    case Policy::frontier:
      return best_by([&](std::size_t i) { return static_cast<double>(gains[i].unknown_voxels); });
    case Policy::random:
      return static_cast<std::size_t>(mix64(mix64(config_.seed) ^ model_.grid().views().size()) %
                                      candidates.size());
    case Policy::kriegel:
      return choose_by_boundary(candidates);
    case Policy::oracle:
      return oracle_->next(candidates);
    case Policy::sequence:
    case Policy::fibonacci:
      break;
  }
  return 0;
}

std::optional<std::size_t> PolicyDecision::choose_by_boundary(
    std::span<const Candidate> candidates) {
  if (const auto next = order_.next(candidates, generation_.estimated())) return next;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // A pose of the reachable list.
    if (!candidates[i].boundary_class && candidates[i].generator != kHazardViews) return i;
  }
  return std::nullopt;
}

}  // namespace viewgain
