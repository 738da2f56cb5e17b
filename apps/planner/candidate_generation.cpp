// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "candidate_generation.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "feasible_poses.hpp"
#include "view_sight.hpp"

namespace viewgain::app {

EstimatorConfig default_estimator(double spacing) {
  constexpr double kDegree = std::numbers::pi / 180;
  EstimatorConfig config;
  config.boundary.min_run_length = 8 * spacing;
  config.boundary.min_loop_length = 8 * spacing;
  config.overlap = 0.25;
  config.region_depth = 0.08;
  config.distances = {1.0, 1.15};
  config.tilts = {0.0, 15 * kDegree, -15 * kDegree};
  config.rolls = {0.0, 90 * kDegree};
  return config;
}

GenerationConfig default_generation(const Sensor& sensor, double voxel_size) {
  GenerationConfig config;
  // As far apart as the points of the surface will be.
  const double footprint = sigmas(sensor.noise, sensor.working_distance, sensor.camera.fx).lateral;
  config.estimator = default_estimator(std::max(voxel_size, footprint));
  config.working_distance = sensor.working_distance;
  config.feasibility = feasibility_of(sensor);
  return config;
}

CandidateGeneration::CandidateGeneration(const Model& model, const Sensor& sensor,
                                         const GenerationConfig& config, const LoopExec& exec)
    : model_(model), sensor_(sensor), config_(config), exec_(exec) {}

void CandidateGeneration::estimate(std::span<const Pose> views) {
  estimated_ = {};
  if (!config_.boundary) return;
  std::optional<ViewSight> sight;
  std::function<bool(std::size_t, const Eigen::Vector3d&)> sees;
  if (config_.classes_by_sight) {
    sight.emplace(model_.scene(), sensor_, views, exec_.threads);
    sees = [&sight](std::size_t view, const Eigen::Vector3d& p) { return sight->sees(view, p); };
  }
  estimated_ = estimate_views(model_.surface(), views, sensor_, config_.working_distance,
                              config_.estimator, sees);
}

std::vector<Candidate> CandidateGeneration::all_candidates() const {
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < estimated_.candidates.size(); ++i) {
    const BoundaryCandidate& c = estimated_.candidates[i];
    all.push_back({c.T_world_camera, "boundary", c.boundary_class, i});
  }
  for (const PoseSet& set : config_.sets) {
    for (std::size_t i = 0; i < set.poses.size(); ++i) {
      all.push_back({set.poses[i], set.generator, std::nullopt, i});
    }
  }
  return all;
}

Proposal CandidateGeneration::generate(const Pose&) {
  const auto measuring = exec_.measure("candidates");
  const std::vector<Pose>& views = model_.grid().views();
  estimate(views);
  std::vector<Candidate> all = all_candidates();

  checker_ = checker_ ? checker_->with_scene(model_.scene())
                      : FeasibilityChecker(model_.scene(), config_.feasibility, exec_.threads);
  std::vector<Pose> poses;
  poses.reserve(all.size());
  for (const Candidate& candidate : all) poses.push_back(candidate.T_world_camera);
  const std::vector<Infeasibility> reasons = checker_->check(poses, views);

  Proposal proposal;
  dropped_.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (reasons[i] == Infeasibility::none) {
      proposal.candidates.push_back(std::move(all[i]));
    } else {
      ++proposal.dropped[std::string(infeasibility_name(reasons[i]))];
      dropped_.push_back({std::move(all[i]), reasons[i]});
    }
  }
  return proposal;
}

}  // namespace viewgain::app
