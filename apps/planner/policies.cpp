// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "policies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "proximity_measure.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/mix64.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain::app {
namespace {

// What a gain is worth after the way to it.
double utility(const TravelCost& cost, double gain, double distance) {
  if (cost.speed) return gain / (cost.seconds_per_view + distance / *cost.speed);
  return gain - cost.per_metre * distance;
}

std::vector<Pose> poses_of(std::span<const Candidate> candidates) {
  std::vector<Pose> poses;
  poses.reserve(candidates.size());
  for (const Candidate& candidate : candidates) poses.push_back(candidate.T_world_camera);
  return poses;
}

}  // namespace

const std::vector<std::string>& policy_names() {
  static const std::vector<std::string> names{"gain",     "kriegel",   "sequence",  "random",
                                              "frontier", "fibonacci", "proximity", "oracle"};
  return names;
}

Policy parse_policy(std::string_view name) {
  const std::vector<std::string>& names = policy_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    std::string text = "unknown policy \"" + std::string(name) + "\"; valid are";
    for (const std::string& valid : names) text.append(" ").append(valid);
    throw Error(ErrorCode::invalid_argument, text);
  }
  return static_cast<Policy>(found - names.begin());
}

void set_stop_rules(PlanningConfig& planning, const PolicyConfig& policy,
                    std::optional<double> stop_gain, std::optional<double> stop_area) {
  if (stop_gain && !(*stop_gain >= 0 && std::isfinite(*stop_gain))) {
    throw Error(ErrorCode::invalid_argument, "--stop-gain (stop_gain) " + short_text(*stop_gain) +
                                                 " must be at least 0 and finite");
  }
  if (stop_area && !(*stop_area >= 0 && *stop_area < 1)) {
    throw Error(ErrorCode::invalid_argument, "--stop-area (stop_area) " + short_text(*stop_area) +
                                                 " must be at least 0 and less than 1");
  }
  const bool expects_area = policy.policy == Policy::gain && policy.model != GainModel::paper;
  const bool by_paper = policy.policy == Policy::gain && policy.model == GainModel::paper;
  if (!expects_area && stop_area.value_or(0) > 0) {
    throw Error(ErrorCode::invalid_argument,
                "--stop-area (stop_area) goes with policy gain by the gains surface and combined");
  }
  if (!by_paper && stop_gain.value_or(0) > 0) {
    throw Error(ErrorCode::invalid_argument,
                "--stop-gain (stop_gain) goes with policy gain by the gain paper");
  }
  if (expects_area && policy.model == GainModel::combined && policy.criterion == Criterion::trace) {
    throw Error(ErrorCode::invalid_argument,
                "--criterion trace (criterion) goes with --gain paper or surface: the combined "
                "gain is in nats");
  }
  planning.stop_gain_is_relative = policy.criterion == Criterion::trace && !stop_gain;
  planning.stop_gain = stop_gain.value_or(planning.stop_gain_is_relative ? 0.01 : kStopGain);
  planning.stop_area = stop_area.value_or(expects_area ? kStopArea : 0.0);
}

PolicyDecision::PolicyDecision(const Model& model, const CandidateGeneration& generation,
                               const Sensor& sensor, const PolicyConfig& config,
                               const LoopExec& exec)
    : model_(model),
      generation_(generation),
      sensor_(sensor),
      config_(config),
      exec_(exec),
      order_(0.5 * generation.config().estimator.patch_length) {
  if (config.policy == Policy::oracle) oracle_.emplace(model, sensor, config.object, exec);
}

std::optional<Decision> PolicyDecision::decide(const Pose& T_world_camera,
                                               std::span<const Candidate> candidates) {
  if (candidates.empty()) return std::nullopt;
  const auto measuring = exec_.measure("score");
  const bool by_gain = config_.policy == Policy::gain;
  if (evaluator_) {
    evaluator_ = evaluator_->with_scene(model_.scene());
  } else {
    GainConfig gain;
    gain.criterion = config_.criterion;
    gain.support_plane = config_.support_plane;
    if (by_gain) gain.model = config_.model;
    evaluator_.emplace(model_.scene(), sensor_, gain, exec_.threads);
  }
  const GainEvaluator& evaluator = *evaluator_;
  const bool scored = by_gain || config_.policy == Policy::frontier;
  const std::vector<ViewGain> gains =
      scored ? score(T_world_camera, candidates) : std::vector<ViewGain>(candidates.size());
  const std::optional<std::size_t> chosen = choose(T_world_camera, candidates, gains);
  if (!chosen) return std::nullopt;
  const ViewGain gain =
      scored ? gains[*chosen] : evaluator.evaluate(candidates[*chosen].T_world_camera);
  Decision decision;
  decision.candidate = *chosen;
  decision.gain = gain.gain;
  const std::uint32_t touched = gain.unknown_voxels + gain.occupied_voxels;
  decision.area =
      std::isnan(gain.area) ? expected_area(candidates[*chosen].T_world_camera) : gain.area;
  // A fixed order of views does not stop because one of them promises little.
  if (!by_gain) return decision;
  if (config_.model == GainModel::paper) {
    decision.gain_per_voxel = touched > 0 ? gain.gain / touched : 0.0;
  } else {
    decision.best_area = 0;
    for (const ViewGain& g : gains) decision.best_area = std::fmax(decision.best_area, g.area);
  }
  return decision;
}

std::vector<ViewGain> PolicyDecision::score(const Pose& T_world_camera,
                                            std::span<const Candidate> candidates) const {
  const std::vector<Pose> poses = poses_of(candidates);
  ViewGain none;
  none.gain = none.area = std::numeric_limits<double>::quiet_NaN();
  std::vector<ViewGain> gains(poses.size(), none);
  const bool in_two_stages = config_.policy == Policy::gain && config_.model != GainModel::paper;
  if (!in_two_stages || config_.travel.speed) {
    evaluator_->evaluate(poses, gains);
    return gains;
  }
  std::vector<double> costs;
  if (config_.travel.per_metre > 0) {
    for (const Pose& pose : poses) {
      const double distance = (pose.translation() - T_world_camera.translation()).norm();
      costs.push_back(config_.travel.per_metre * distance);
    }
  }
  RaceConfig config;
  config.costs = costs;
  const RacedViews raced = evaluator_->race(poses, 1, config);
  for (std::size_t j = 0; j < raced.scored_indices.size(); ++j) {
    gains[raced.scored_indices[j]] = raced.scored_gains[j];
  }
  return gains;
}

std::size_t PolicyDecision::most_proximity(std::span<const Candidate> candidates) {
  if (coarse_) {
    coarse_ = coarse_->with_scene(model_.scene());
  } else {
    GainConfig config;
    config.pixel_stride = coarse_stride(sensor_.camera);
    config.support_plane = config_.support_plane;
    coarse_.emplace(model_.scene(), sensor_, config, exec_.threads);
  }
  std::vector<double> values(candidates.size());
  coarse_->evaluate(poses_of(candidates), ProximityMeasure(model_.scene()->hazard()), values);
  std::size_t best = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] > values[best] || std::isnan(values[best])) best = i;
  }
  return best;
}

double PolicyDecision::expected_area(const Pose& T_world_camera) {
  if (area_evaluator_) {
    area_evaluator_ = area_evaluator_->with_scene(model_.scene());
  } else {
    GainConfig config;
    config.model = GainModel::surface;
    config.support_plane = config_.support_plane;
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
        return utility(config_.travel, gains[i].gain, distance);
      });
    case Policy::frontier:
      return best_by([&](std::size_t i) { return static_cast<double>(gains[i].unknown_voxels); });
    case Policy::random:
      return static_cast<std::size_t>(mix64(mix64(config_.seed) ^ model_.grid().views().size()) %
                                      candidates.size());
    case Policy::kriegel:
      return choose_by_boundary(candidates);
    case Policy::proximity:
      return most_proximity(candidates);
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
    if (!candidates[i].boundary_class) return i;  // a pose of the reachable list
  }
  return std::nullopt;
}

}  // namespace viewgain::app
