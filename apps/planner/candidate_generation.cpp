// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "candidate_generation.hpp"

#include <utility>

#include "stopwatch.hpp"

namespace viewgain::app {

CandidateGeneration::CandidateGeneration(const Model& model, const Sensor& sensor,
                                         const GenerationConfig& config, const ExecConfig& exec,
                                         StageSeconds& seconds)
    : model_(model), sensor_(sensor), config_(config), exec_(exec), seconds_(seconds) {}

Proposal CandidateGeneration::generate(const Pose&) {
  const Stopwatch watch;
  const std::vector<Pose>& views = model_.grid().views();
  std::vector<Candidate> all;
  estimated_ = {};
  if (config_.boundary) {
    estimated_ = estimate_views(model_.surface(), views, sensor_, config_.working_distance,
                                config_.estimator);
    for (const BoundaryCandidate& c : estimated_.candidates) {
      all.push_back({c.T_world_camera, "boundary",
                     std::string(boundary_class_name(c.boundary_class)), c.patch});
    }
  }
  for (const PoseSet& set : config_.sets) {
    for (std::size_t i = 0; i < set.poses.size(); ++i) {
      all.push_back({set.poses[i], set.generator, "", static_cast<std::int64_t>(i)});
    }
  }

  checker_ = checker_ ? checker_->with_scene(model_.scene())
                      : FeasibilityChecker(model_.scene(), config_.feasibility, exec_);
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
  seconds_["candidates"] += watch.seconds();
  return proposal;
}

}  // namespace viewgain::app
