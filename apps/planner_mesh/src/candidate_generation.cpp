// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/candidate_generation.hpp"

#include <string>
#include <utility>

namespace viewgain {

GenerationConfig default_generation(const Sensor& sensor, double voxel_size) {
  GenerationConfig config;
  config.boundary = default_boundary(sensor, voxel_size);
  config.feasibility = feasibility_of(sensor);
  return config;
}

CandidateGeneration::CandidateGeneration(const SurfaceModel& model, const Sensor& sensor,
                                         const GenerationConfig& config, const ExecConfig& exec)
    : model_(model), sensor_(sensor), config_(config), exec_(exec) {}

std::vector<Candidate> CandidateGeneration::all_candidates() const {
  std::vector<Candidate> all = candidates_of(estimated_);
  for (const PoseSet& set : config_.sets) {
    for (std::size_t i = 0; i < set.poses.size(); ++i) {
      all.push_back({set.poses[i], set.generator, std::nullopt, i});
    }
  }
  return all;
}

Proposal CandidateGeneration::generate(const Pose&) {
  const std::vector<Pose>& views = model_.grid().views();
  estimated_ = {};
  if (config_.at_boundaries) {
    estimated_ =
        boundary_views(model_.surface(), model_.scene(), views, sensor_, config_.boundary, exec_);
  }
  std::vector<Candidate> all = all_candidates();

  checker_ = checker_ ? checker_->with_scene(model_.scene())
                      : FeasibilityChecker(model_.scene(), config_.feasibility, exec_);
  std::vector<std::string> reasons;
  reasons.reserve(all.size());
  for (const Infeasibility reason : checker_->check(poses_of(all), views)) {
    reasons.emplace_back(reason == Infeasibility::none ? "" : infeasibility_name(reason));
  }
  Proposal proposal;
  dropped_.clear();
  sort_candidates(std::move(all), reasons, proposal, dropped_);
  return proposal;
}

}  // namespace viewgain
