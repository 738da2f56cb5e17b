// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/policies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

#include "viewgain/core/error.hpp"
#include "viewgain/planner/hazard_views.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/planner/stop_settings.hpp"
#include "viewgain/planner_mesh/mesh_area.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

// Distance of each patch from the middle of its run, in patches.
std::vector<double> distances_from_the_middle(const EstimatedViews& estimated) {
  const std::vector<std::uint32_t>& run_of_patch = estimated.run_of_patch;
  std::vector<double> distances(run_of_patch.size());
  for (std::size_t first = 0; first < run_of_patch.size();) {
    std::size_t end = first;
    while (end < run_of_patch.size() && run_of_patch[end] == run_of_patch[first]) ++end;
    const double middle = 0.5 * static_cast<double>(first + end - 1);
    for (; first < end; ++first) distances[first] = std::abs(static_cast<double>(first) - middle);
  }
  return distances;
}

// Pixel stride with about 400 rays per view, which rank views nearly as well as all rays.
int coarse_stride(const PinholeCamera& camera) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  return std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / 400))));
}

const double kLeastCosine = std::cos(72.0 * std::numbers::pi / 180);

const KnownObject& checked(const KnownObject& object) {
  if (!object.mesh || !object.truth) {
    refuse("policy \"oracle\" requires the mesh of the object, so it works only in simulations");
  }
  return object;
}

SimulationConfig without_noise(SimulationConfig config) {
  config.noise = config.lateral_noise = false;
  config.scale_error = 0;
  config.sub_rays = 1;
  return config;
}

}  // namespace

std::vector<bool> BoundaryOrder::tried_runs(const EstimatedViews& estimated) const {
  std::vector<bool> tried(estimated.runs.size());
  for (std::size_t patch = 0; patch < estimated.patches.size(); ++patch) {
    const std::uint32_t run = estimated.run_of_patch[patch];
    for (const Try& before : tried_) {
      if (before.boundary_class == estimated.runs[run].boundary_class &&
          (before.place - estimated.patches[patch].origin).norm() <= same_place_) {
        tried[run] = true;
      }
    }
  }
  return tried;
}

std::optional<std::size_t> BoundaryOrder::next(std::span<const Candidate> candidates,
                                               const EstimatedViews& estimated) {
  const std::vector<bool> tried = tried_runs(estimated);
  const std::vector<double> off_middle = distances_from_the_middle(estimated);
  const auto proposed = [&](std::size_t i) -> const BoundaryCandidate& {
    return estimated.candidates[candidates[i].number.value()];
  };
  const auto rank = [&](const BoundaryCandidate& c) {
    return std::tuple(c.boundary_class, -estimated.runs[c.run].length, c.run, off_middle[c.patch],
                      c.patch);
  };
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!candidates[i].boundary_class) continue;  // a pose from the reach region's list
    if (!proposed(i).nominal || tried[proposed(i).run]) continue;
    if (!first || rank(proposed(i)) < rank(proposed(*first))) first = i;
  }
  if (first) {
    const BoundaryCandidate& c = proposed(*first);
    tried_.push_back({c.boundary_class, estimated.patches[c.patch].origin});
  }
  return first;
}

RegisteredChoice::RegisteredChoice(const SurfaceModel& model, const Sensor& sensor,
                                   std::string gain, const ExecConfig& exec)
    : model_(model), sensor_(sensor), gain_(std::move(gain)), exec_(exec) {}

std::vector<double> RegisteredChoice::gains(std::span<const Pose> T_world_camera, bool all) const {
  const auto evaluator = registered_gains().evaluator(model_.scene(), model_.grid(), sensor_,
                                                      std::span(&gain_, 1), exec_);
  const auto gains_of = [&](std::span<const Pose> poses, int stride) {
    std::vector<double> gains(poses.size());
    evaluator->evaluate(poses, stride, gains, {}, {});
    return gains;
  };
  if (all || T_world_camera.size() <= kInFull) return gains_of(T_world_camera, 1);

  std::vector<double> few = gains_of(T_world_camera, coarse_stride(sensor_.camera));
  for (double& gain : few) {
    if (std::isnan(gain)) gain = -std::numeric_limits<double>::infinity();
  }
  std::vector<std::size_t> order(few.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return few[a] > few[b]; });
  order.resize(kInFull);
  std::vector<Pose> best;
  for (const std::size_t i : order) best.push_back(T_world_camera[i]);
  const std::vector<double> exact = gains_of(best, 1);
  std::vector<double> gains(few.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < order.size(); ++k) gains[order[k]] = exact[k];
  return gains;
}

OracleChoice::OracleChoice(const SurfaceModel& model, const Sensor& sensor,
                           const KnownObject& object, const ExecConfig& exec)
    : model_(model),
      sensor_(sensor),
      object_(checked(object)),
      exec_(exec),
      camera_(object.mesh, sensor, without_noise(object.simulation), exec) {}

std::vector<double> OracleChoice::uncovered_in_view(std::span<const Candidate> candidates) const {
  const GroundTruth& truth = object_.truth->ground_truth();
  const std::vector<double> distances = truth.distances_to(model_.surface().vertices);
  std::vector<SurfaceSample> uncovered;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (!(distances[i] <= object_.truth->tolerance())) uncovered.push_back(truth.samples()[i]);
  }
  // Distant readings are too inaccurate to become points of the surface.
  const auto worth = [&](const Eigen::Vector3d& sight) {
    return 1 / (1 + sensor_.noise_sigmas(sight.norm()).axial / model_.grid().voxel_size());
  };
  std::vector<double> counts(candidates.size());
  ThreadPool pool(exec_.num_threads);
  pool.for_each_chunk(candidates.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::vector<std::uint8_t> seen(uncovered.size());
      mark_seen(*object_.mesh, object_.simulation.surroundings.get(), sensor_,
                candidates[i].T_world_camera, kLeastCosine, uncovered, seen);
      const Eigen::Vector3d eye = candidates[i].T_world_camera.translation();
      for (std::size_t k = 0; k < seen.size(); ++k) {
        if (seen[k] != 0) counts[i] += worth(uncovered[k].position - eye);
      }
    }
  });
  return counts;
}

std::size_t OracleChoice::covered_after(const Pose& T_world_camera) const {
  const auto points = model_.points_after({T_world_camera, {camera_.acquire(T_world_camera)}});
  const std::vector<double> distances =
      object_.truth->ground_truth().distances_to(arrays_of(points).positions);
  return static_cast<std::size_t>(std::count_if(distances.begin(), distances.end(), [&](double d) {
    return d <= object_.truth->tolerance();
  }));
}

std::size_t OracleChoice::next(std::span<const Candidate> candidates) const {
  const std::vector<double> counts = uncovered_in_view(candidates);
  std::vector<std::size_t> ranking(candidates.size());
  std::iota(ranking.begin(), ranking.end(), std::size_t{0});
  std::stable_sort(ranking.begin(), ranking.end(),
                   [&](std::size_t a, std::size_t b) { return counts[a] > counts[b]; });
  ranking.resize(std::min(ranking.size(), kSimulated));
  std::sort(ranking.begin(), ranking.end());
  std::size_t best = ranking.front(), most = 0;
  for (const std::size_t i : ranking) {
    const std::size_t covered = covered_after(candidates[i].T_world_camera);
    if (covered > most) most = covered, best = i;
  }
  return best;
}

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
  const bool by_gain = policy.policy == Policy::gain && policy.registered.empty();
  if (!by_gain && stop_area.value_or(0) > 0) {
    refuse("stop_area requires policy gain with the gain surface or combined");
  }
  if (!by_gain && stop_gain.value_or(0) > 0) {
    refuse("stop_gain requires policy gain with the gain paper");
  }
  // Policies without a gain get the rules of the paper's gain, which never stop them.
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
    refuse("planning ahead requires policy gain with the gain paper, surface or combined");
  }
  if (config.policy == Policy::oracle) oracle_.emplace(model, sensor, config.object, exec);
  if (config.policy == Policy::gain && !config.registered.empty()) {
    registered_.emplace(model, sensor, config.registered, exec);
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
  const GainEvaluator& by = evaluator();
  const RankConfig rank{.cost_per_metre = config_.cost_per_metre, .current_pose = T_world_camera};
  if (is_of_plan_) {
    planned_.erase(planned_.begin());
    return decision_of(rank_in_turn(by, poses, rank), config_.model);
  }
  const Ranking ranking = config_.ahead.is_on() ? plan_views(by, poses, config_.ahead,
                                                             mesh_area(model_.surface()), rank)
                                                : rank_views(by, poses, 1, rank);
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
  const bool scored = registered_ || config_.policy == Policy::frontier;
  const std::vector<ViewGain> gains = registered_ ? score_registered(candidates)
                                      : scored    ? evaluator.evaluate(poses_of(candidates))
                                                  : std::vector<ViewGain>(candidates.size());
  const std::optional<std::size_t> chosen = choose(T_world_camera, candidates, gains);
  if (!chosen) return std::nullopt;
  const ViewGain gain =
      scored ? gains[*chosen] : evaluator.evaluate(candidates[*chosen].T_world_camera);
  DecisionMaking::Decision decision;
  decision.candidate = *chosen;
  decision.gain = gain.gain;
  // A fixed order of views does not stop at a view with little expected surface.
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

std::vector<ViewGain> PolicyDecision::score_registered(std::span<const Candidate> candidates) {
  const bool way_counts = config_.cost_per_metre > 0;
  const std::vector<double> values = registered_->gains(poses_of(candidates), way_counts);
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
    // A pose from the reach region's list.
    const std::string& generator = candidates[i].generator;
    if (!candidates[i].boundary_class && generator != kHazardViews && generator != kReachViews) {
      return i;
    }
  }
  return std::nullopt;
}

}  // namespace viewgain
