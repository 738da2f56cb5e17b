// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/planner_mesh/candidate_generation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/planner/hazard_views.hpp"
#include "viewgain/planner/view_sight.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

// If boundaries give fewer candidates, hazard_views() supply the rest. Adding them to more boundary
// candidates does not help (perf/results/loop.md).
constexpr std::size_t kFewCandidates = 200;

}  // namespace

EstimatorConfig default_estimator(double spacing) {
  if (!(spacing > 0) || !std::isfinite(spacing)) {
    throw Error(
        ErrorCode::invalid_argument,
        "the spacing of surface points must be positive, not " + short_text(spacing) + " m");
  }
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

BoundaryViewsConfig default_boundary(const Sensor& sensor, double voxel_size) {
  BoundaryViewsConfig config;
  // Spacing of the surface's points.
  if (!(voxel_size > 0) || !std::isfinite(voxel_size)) {
    refuse("the voxel size must be positive and finite, not " + short_text(voxel_size) + " m");
  }
  const double footprint = sigmas(sensor.noise, sensor.working_distance, sensor.camera.fx).lateral;
  config.estimator = default_estimator(std::max(voxel_size, footprint));
  config.working_distance = sensor.working_distance;
  return config;
}

EstimatedViews boundary_views(const SurfaceMesh& surface,
                              const std::shared_ptr<const VoxelScene>& scene,
                              std::span<const Pose> views, const Sensor& sensor,
                              const BoundaryViewsConfig& config, const ExecConfig& exec) {
  std::optional<ViewSight> sight;
  std::function<bool(std::size_t, const Eigen::Vector3d&)> sees;
  if (config.classes_by_sight) {
    sight.emplace(scene, sensor, views, exec);
    sees = [&sight](std::size_t view, const Eigen::Vector3d& p) { return sight->sees(view, p); };
  }
  return estimate_views(surface, views, sensor, config.working_distance, config.estimator, sees);
}

std::vector<Candidate> candidates_of(const EstimatedViews& estimated) {
  std::vector<Candidate> candidates;
  candidates.reserve(estimated.candidates.size());
  for (std::size_t i = 0; i < estimated.candidates.size(); ++i) {
    const BoundaryCandidate& c = estimated.candidates[i];
    candidates.push_back({c.T_world_camera, "boundary", c.boundary_class, i});
  }
  return candidates;
}

BoundaryGeneration::BoundaryGeneration(const ViewScorer& scorer, const BoundaryViewsConfig& config,
                                       const ExecConfig& exec)
    : scorer_(scorer), config_(config), exec_(exec) {}

BoundaryGeneration::BoundaryGeneration(const SurfaceModel& model, const BoundaryViewsConfig& config,
                                       const ExecConfig& exec)
    : scorer_(model.scorer()), model_(&model), config_(config), exec_(exec) {}

Proposal BoundaryGeneration::generate(const Pose&) {
  estimated_ = {};
  SurfaceMesh made;
  if (model_ == nullptr) made = surface_of(fused_points(scorer_.grid(), {}, exec_), exec_);
  const SurfaceMesh& surface = model_ != nullptr ? model_->surface() : made;
  if (scorer_.grid().views().empty() || surface.triangles.empty()) {
    PoseSet sphere = make_pose_set("sphere", around_workspace(scorer_.grid(), scorer_.sensor()));
    Proposal proposal;
    for (std::size_t i = 0; i < sphere.poses.size(); ++i) {
      proposal.candidates.push_back({sphere.poses[i], sphere.generator, std::nullopt, i});
    }
    return proposal;
  }
  estimated_ = boundary_views(surface, scorer_.scene(), scorer_.grid().views(), scorer_.sensor(),
                              config_, exec_);
  Proposal proposal{candidates_of(estimated_), {}};
  const std::size_t found = proposal.candidates.size();
  if (found >= kFewCandidates) return proposal;
  const std::vector<Pose> views =
      hazard_views(*scorer_.scene(), config_.working_distance, 0.5 * config_.estimator.patch_length,
                   kFewCandidates - found);
  for (std::size_t i = 0; i < views.size(); ++i) {
    proposal.candidates.push_back({views[i], std::string(kHazardViews), std::nullopt, i});
  }
  return proposal;
}

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
      proposer_(model.scene(), {config.feasibility, true, config.boundary.working_distance}, exec) {
  for (const PoseSet& set : config.sets) proposer_.add_poses(set);
  if (config.at_boundaries) proposer_.add_generation(boundaries_);
}

std::vector<Pose> CandidateGeneration::tried() const {
  std::vector<Pose> tried = config_.tried;
  tried.insert(tried.end(), model_.tried().begin(), model_.tried().end());
  return tried;
}

Proposal CandidateGeneration::generate(const Pose& T_world_camera) {
  return proposer_.propose(model_.grid(), model_.scene(), T_world_camera, tried());
}

Proposal CandidateGeneration::propose_these(const PoseSet& set) {
  return proposer_.propose_these(set, model_.grid(), model_.scene(), tried());
}

}  // namespace viewgain
