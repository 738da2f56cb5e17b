// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/policies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "viewgain/core/error.hpp"
#include "viewgain/planner/hazard_views.hpp"
#include "viewgain/planner/proximity_measure.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner/stop_settings.hpp"
#include "viewgain/support/mix64.hpp"
#include "viewgain/support/nearest_name.hpp"

namespace viewgain {
const std::vector<std::string>& policy_names() {
  static const std::vector<std::string> names{"gain",     "kriegel",   "sequence",  "random",
                                              "frontier", "fibonacci", "proximity", "oracle"};
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

PolicyDecision::PolicyDecision(const SurfaceModel& model, const CandidateGeneration& generation,
                               const Sensor& sensor, const PolicyConfig& config,
                               const ExecConfig& exec)
    : model_(model),
      generation_(generation),
      sensor_(sensor),
      config_(config),
      exec_(exec),
      order_(0.5 * generation.config().boundary.estimator.patch_length) {
  if (config.policy == Policy::oracle) oracle_.emplace(model, sensor, config.object, exec);
  if (config.policy == Policy::gain && config.classic) {
    classic_.emplace(model, sensor, *config.classic, exec);
  }
}

std::optional<DecisionMaking::Decision> PolicyDecision::decide(
    const Pose& T_world_camera, std::span<const Candidate> candidates) {
  if (candidates.empty()) return std::nullopt;
  const bool by_gain = config_.policy == Policy::gain && !classic_;
  const GainEvaluator& evaluator = this->evaluator();
  const bool scored = by_gain || classic_ || config_.policy == Policy::frontier;
  const std::vector<ViewGain> gains = classic_ ? score_classic(candidates)
                                      : scored ? score(T_world_camera, candidates)
                                               : std::vector<ViewGain>(candidates.size());
  const std::optional<std::size_t> chosen = choose(T_world_camera, candidates, gains);
  if (!chosen) return std::nullopt;
  const ViewGain gain =
      scored ? gains[*chosen] : evaluator.evaluate(candidates[*chosen].T_world_camera);
  DecisionMaking::Decision decision;
  decision.candidate = *chosen;
  decision.gain = gain.gain;
  const std::uint32_t touched = gain.unknown_voxels + gain.occupied_voxels;
  decision.area =
      std::isnan(gain.area) ? expected_area(candidates[*chosen].T_world_camera) : gain.area;
  // A fixed order of views does not stop because one of them promises little.
  if (!by_gain) return decision;
  if (config_.travel_cost > 0) {
    const Eigen::Vector3d way =
        candidates[*chosen].T_world_camera.translation() - T_world_camera.translation();
    decision.worth = gain.gain - config_.travel_cost * way.norm();
  }
  if (config_.model == GainModel::paper) {
    decision.gain_per_voxel = touched > 0 ? gain.gain / touched : 0.0;
  } else {
    decision.best_area = 0;
    for (const ViewGain& g : gains) decision.best_area = std::fmax(decision.best_area, g.area);
  }
  return decision;
}

const GainEvaluator& PolicyDecision::evaluator() {
  if (evaluator_) {
    evaluator_ = evaluator_->with_scene(model_.scene());
  } else {
    GainConfig gain;
    gain.criterion = config_.criterion;
    // Other policies count unknown voxels, as the paper's gain does.
    gain.model = config_.policy == Policy::gain && !classic_ ? config_.model : GainModel::paper;
    evaluator_.emplace(model_.scene(), sensor_, gain, exec_);
  }
  return *evaluator_;
}

std::optional<CandidateScores> PolicyDecision::scores(std::span<const Candidate> candidates) {
  CandidateScores scores;
  scores.area.assign(candidates.size(), std::numeric_limits<double>::quiet_NaN());
  if (config_.policy == Policy::proximity) {
    scores.score = proximities(candidates);
    return scores;
  }
  if (classic_) {
    scores.score = classic_->gains(poses_of(candidates), /*all=*/true);
    return scores;
  }
  const bool by_gain = config_.policy == Policy::gain;
  if (!by_gain && config_.policy != Policy::frontier) return std::nullopt;
  const std::vector<ViewGain> gains = evaluator().evaluate(poses_of(candidates));
  for (std::size_t i = 0; i < gains.size(); ++i) {
    scores.score.push_back(by_gain ? gains[i].gain : static_cast<double>(gains[i].unknown_voxels));
    scores.area[i] = gains[i].area;
  }
  return scores;
}

std::vector<ViewGain> PolicyDecision::score(const Pose& T_world_camera,
                                            std::span<const Candidate> candidates) const {
  const std::vector<Pose> poses = poses_of(candidates);
  ViewGain none;
  none.gain = none.area = std::numeric_limits<double>::quiet_NaN();
  std::vector<ViewGain> gains(poses.size(), none);
  const bool in_two_stages = config_.policy == Policy::gain && config_.model != GainModel::paper;
  if (!in_two_stages) {
    evaluator_->evaluate(poses, gains);
    return gains;
  }
  RankConfig rank;
  rank.cost_per_metre = config_.travel_cost;
  const Ranking ranking = rank_views(*evaluator_, poses, 1, rank, T_world_camera.translation());
  for (std::size_t j = 0; j < ranking.scored_indices.size(); ++j) {
    gains[ranking.scored_indices[j]] = ranking.scored_gains[j];
  }
  return gains;
}

std::vector<ViewGain> PolicyDecision::score_classic(std::span<const Candidate> candidates) {
  const bool way_counts = config_.travel_cost > 0;
  const std::vector<double> values = classic_->gains(poses_of(candidates), way_counts);
  std::vector<ViewGain> gains(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) gains[i].gain = values[i];
  return gains;
}

std::vector<double> PolicyDecision::proximities(std::span<const Candidate> candidates) {
  if (coarse_) {
    coarse_ = coarse_->with_scene(model_.scene());
  } else {
    GainConfig config;
    config.pixel_stride = coarse_stride(sensor_.camera);
    coarse_.emplace(model_.scene(), sensor_, config, exec_);
  }
  std::vector<double> values(candidates.size());
  coarse_->evaluate(poses_of(candidates), values, ProximityMeasure(model_.scene()->hazard()));
  return values;
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
        return gains[i].gain - config_.travel_cost * distance;
      });
    case Policy::frontier:
      return best_by([&](std::size_t i) { return static_cast<double>(gains[i].unknown_voxels); });
    case Policy::random:
      return static_cast<std::size_t>(mix64(mix64(config_.seed) ^ model_.grid().views().size()) %
                                      candidates.size());
    case Policy::kriegel:
      return choose_by_boundary(candidates);
    case Policy::proximity: {
      const std::vector<double> values = proximities(candidates);
      return best_by([&](std::size_t i) { return values[i]; });
    }
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
