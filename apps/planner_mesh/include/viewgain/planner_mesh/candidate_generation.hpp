// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain {

/// How views at the surface's open boundaries are made.
struct VIEWGAIN_EXPORT BoundaryViewsConfig {
  EstimatorConfig estimator{};  ///< how views are estimated at a boundary
  double working_distance = 0;  ///< from the surface [m]
  /// A boundary is classed by the last view that has it in sight past the rest of the map, not only
  /// in its image; a view is traced for that. Moves the ends of runs, and so the candidates.
  bool classes_by_sight = false;
};

/// A number of variants that makes a large batch: two distances, tilts of 15° to four sides, two
/// rolls; a quarter of a view overlaps with what is known; regions of 80 mm. `spacing` of the
/// surface's points [m]; Error(invalid_argument) unless it is positive.
[[nodiscard]] VIEWGAIN_EXPORT EstimatorConfig default_estimator(double spacing);

/// default_estimator() for the surface that a map of these voxels (voxel_size [m]) will have, at
/// the sensor's working distance. Throws as that.
[[nodiscard]] VIEWGAIN_EXPORT BoundaryViewsConfig default_boundary(const Sensor& sensor,
                                                                   double voxel_size);

/// The views at the open boundaries of a map's surface, possible or not; `views`: T_world_camera of
/// those so far, in their order. Throws and costs as estimate_views(), with classes_by_sight as
/// ViewSight, too.
[[nodiscard]] VIEWGAIN_EXPORT EstimatedViews
boundary_views(const SurfaceMesh& surface, const std::shared_ptr<const VoxelScene>& scene,
               std::span<const Pose> views, const Sensor& sensor, const BoundaryViewsConfig& config,
               const ExecConfig& exec);

/// These as candidates of the generator "boundary", in their order, numbered by it. Never throws.
/// Costs O(candidates).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Candidate> candidates_of(const EstimatedViews& estimated);

/// VIEWPOINTSGENERATION at the boundaries of the surface in a map, made anew for each proposal.
/// Where these are fewer than 200, hazard_views() are the rest: holes that no boundary names, and
/// surface that is still expected where nothing is open. What ViewPlanner::add_generation() takes.
/// Nothing is dropped; the planner looks what is possible. Where the map has no surface yet, or no
/// views (as an OctoMap), a sphere round the workspace is proposed. Thread safety: one call at a
/// time. Cost: the surface is made anew, fused_points() and reconstruct_surface(), estimate_views()
/// and hazard_views().
class VIEWGAIN_EXPORT BoundaryGeneration : public ViewpointGeneration {
 public:
  /// Of the surface in a map, say ViewPlanner::scorer(), which must outlive it; it is made anew for
  /// each proposal.
  BoundaryGeneration(const ViewScorer& scorer, const BoundaryViewsConfig& config,
                     const ExecConfig& exec = {});
  /// Of a model's surface as it is; the model must outlive it.
  BoundaryGeneration(const SurfaceModel& model, const BoundaryViewsConfig& config,
                     const ExecConfig& exec = {});

  /// Those at the open boundaries of the surface as it is, and the hazard's. Throws as
  /// boundary_views().
  Proposal generate(const Pose& T_world_camera) override;

  /// Behind the last proposal.
  [[nodiscard]] const EstimatedViews& estimated() const noexcept { return estimated_; }

 private:
  const ViewScorer& scorer_;
  const SurfaceModel* model_ = nullptr;  // null: the surface is made of the map
  BoundaryViewsConfig config_;
  ExecConfig exec_;
  EstimatedViews estimated_;
};

/// Where candidates come from, and which are possible.
struct VIEWGAIN_EXPORT GenerationConfig {
  bool at_boundaries = true;        ///< candidates of BoundaryGeneration
  BoundaryViewsConfig boundary{};   ///< views at the surface's open boundaries
  std::vector<PoseSet> sets{};      ///< fixed poses, in the order of proposal
  std::vector<Pose> tried{};        ///< views that brought nothing, beside the model's
  FeasibilityConfig feasibility{};  ///< what is possible
};

/// What every loop starts from: boundary candidates by default_boundary(), no sets, feasibility for
/// the sensor and its body, no limits of reach. voxel_size [m] is the map's. Throws as
/// default_boundary().
[[nodiscard]] VIEWGAIN_EXPORT GenerationConfig default_generation(const Sensor& sensor,
                                                                  double voxel_size);

/// VIEWPOINTSGENERATION of Algorithm 1: a ViewProposer with fixed sets and views at the open
/// boundaries of the model's surface. Thread safety: one call at a
/// time. Cost: boundary_views(), and FeasibilityChecker::check() of all candidates.
class VIEWGAIN_EXPORT CandidateGeneration : public ViewpointGeneration {
 public:
  /// The model must outlive it. Throws as FeasibilityChecker.
  CandidateGeneration(const SurfaceModel& model, const GenerationConfig& config,
                      const ExecConfig& exec);

  /// The sets' poses and boundary views that are possible by the rules of ViewProposer. Throws as
  /// boundary_views().
  Proposal generate(const Pose& T_world_camera) override;

  /// Those of a set alone that are possible now.
  [[nodiscard]] Proposal propose_these(const PoseSet& set);

  /// What it was made with.
  [[nodiscard]] const GenerationConfig& config() const noexcept { return config_; }

  /// Behind the last proposal: why its boundary candidates exist. The `number` of a candidate with
  /// a class is its index in estimated().candidates, that of one of a set its index in the set.
  [[nodiscard]] const EstimatedViews& estimated() const noexcept {
    return boundaries_->estimated();
  }
  /// Of the last proposal: the dropped candidates, in their order, each with its reason.
  [[nodiscard]] const std::vector<DroppedCandidate>& dropped() const noexcept {
    return proposer_.dropped();
  }

 private:
  [[nodiscard]] std::vector<Pose> tried() const;

  const SurfaceModel& model_;
  GenerationConfig config_;
  std::shared_ptr<BoundaryGeneration> boundaries_;
  ViewProposer proposer_;
};

}  // namespace viewgain
