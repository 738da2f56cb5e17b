// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/candidate_generation.hpp"

namespace viewgain {

GenerationConfig default_generation(const Sensor& sensor, double voxel_size) {
  GenerationConfig config;
  config.boundary = default_boundary(sensor, voxel_size);
  config.feasibility = feasibility_of(sensor);
  return config;
}

CandidateGeneration::CandidateGeneration(const SurfaceModel& model, const GenerationConfig& config,
                                         const ExecConfig& exec)
    : model_(model),
      config_(config),
      boundaries_(std::make_shared<BoundaryGeneration>(model, config.boundary, exec)),
      proposer_(model.scene(), {config.feasibility}, exec) {
  for (const PoseSet& set : config.sets) proposer_.add_poses(set);
  if (config.at_boundaries) proposer_.add_generation(boundaries_);
}

std::vector<Pose> CandidateGeneration::tried() const {
  std::vector<Pose> tried = config_.tried;
  tried.insert(tried.end(), model_.tried().begin(), model_.tried().end());
  return tried;
}

Proposal CandidateGeneration::generate(const Pose&) {
  return proposer_.propose(model_.grid(), model_.scene(), tried());
}

Proposal CandidateGeneration::propose_these(const PoseSet& set) {
  return proposer_.propose_these(set, model_.grid(), model_.scene(), tried());
}

}  // namespace viewgain
