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

/// Settings of the views at open surface boundaries.
struct VIEWGAIN_EXPORT BoundaryViewsConfig {
  EstimatorConfig estimator{};  ///< estimation of the views at a boundary
  double working_distance = 0;  ///< distance from the surface [m]
  /// Classifies a boundary by the last view that sees it unoccluded, instead of the last one that
  /// has it in its image. Changes the boundary runs (BoundaryRun), and so the candidates. Costs a
  /// trace per view.
  bool classes_by_sight = false;
};

/// Settings for many candidates per boundary: two distances, tilts of 15° to four sides, two rolls,
/// an overlap of a quarter of a view, and regions of 80 mm. `spacing`: that of the surface's points
/// [m]. Throws Error(invalid_argument) unless it is positive.
[[nodiscard]] VIEWGAIN_EXPORT EstimatorConfig default_estimator(double spacing);

/// default_estimator() for the surface of a map with this voxel_size [m], at the sensor's working
/// distance. Throws whatever default_estimator() throws.
[[nodiscard]] VIEWGAIN_EXPORT BoundaryViewsConfig default_boundary(const Sensor& sensor,
                                                                   double voxel_size);

/// Views at the open boundaries of a map's surface, feasible or not. `views`: poses T_world_camera
/// of the views so far, in order. Errors and cost: see estimate_views() and, if classes_by_sight is
/// set, ViewSight.
[[nodiscard]] VIEWGAIN_EXPORT EstimatedViews
boundary_views(const SurfaceMesh& surface, const std::shared_ptr<const VoxelScene>& scene,
               std::span<const Pose> views, const Sensor& sensor, const BoundaryViewsConfig& config,
               const ExecConfig& exec);

/// Converts to candidates of the generator "boundary", in order. Candidate::number is the index in
/// estimated.candidates. Never throws. Cost: O(candidates).
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Candidate> candidates_of(const EstimatedViews& estimated);

/// VIEWPOINTSGENERATION at the surface boundaries of a map, recomputed for each proposal, for
/// ViewPlanner::add_generation(). If there are fewer than 200 candidates, adds hazard_views(),
/// because new surface is also expected at places that are not near a boundary. Does not check
/// feasibility. For a map without surface or views, such as an OctoMap, the candidates lie on a
/// sphere around the workspace. Thread safety: one call at a time. Cost: fused_points(),
/// reconstruct_surface(), estimate_views() and hazard_views().
class VIEWGAIN_EXPORT BoundaryGeneration : public ViewpointGeneration {
 public:
  /// Recomputes the surface of a map, such as that of ViewPlanner::scorer(), for each proposal. The
  /// scorer must outlive this object.
  BoundaryGeneration(const ViewScorer& scorer, const BoundaryViewsConfig& config,
                     const ExecConfig& exec = {});
  /// Uses the current surface of a model, without recomputing it. The model must outlive this
  /// object.
  BoundaryGeneration(const SurfaceModel& model, const BoundaryViewsConfig& config,
                     const ExecConfig& exec = {});

  /// Proposes these candidates. Throws whatever boundary_views() throws.
  Proposal generate(const Pose& T_world_camera) override;

  /// Details of the last proposal.
  [[nodiscard]] const EstimatedViews& estimated() const noexcept { return estimated_; }

 private:
  const ViewScorer& scorer_;
  const SurfaceModel* model_ = nullptr;  // null: the surface is computed from the map
  BoundaryViewsConfig config_;
  ExecConfig exec_;
  EstimatedViews estimated_;
};

/// Sources of candidates, and feasibility.
struct VIEWGAIN_EXPORT GenerationConfig {
  bool at_boundaries = true;        ///< use candidates of BoundaryGeneration
  BoundaryViewsConfig boundary{};   ///< settings of views at open surface boundaries
  std::vector<PoseSet> sets{};      ///< fixed poses, in order
  std::vector<Pose> tried{};        ///< poses of failed views, in addition to the model's
  FeasibilityConfig feasibility{};  ///< settings of the feasibility check
};

/// Default settings of all loops: boundary candidates from default_boundary(), no sets, feasibility
/// of the sensor's body, unlimited reach. voxel_size [m] is the map's. Throws whatever
/// default_boundary() throws.
[[nodiscard]] VIEWGAIN_EXPORT GenerationConfig default_generation(const Sensor& sensor,
                                                                  double voxel_size);

/// VIEWPOINTSGENERATION of Algorithm 1: a ViewProposer with fixed sets and views at the open
/// boundaries of the model's surface. Thread safety: one call at a time. Cost: boundary_views(),
/// and FeasibilityChecker::check() of all candidates.
class VIEWGAIN_EXPORT CandidateGeneration : public ViewpointGeneration {
 public:
  /// The model must outlive this object. Throws whatever FeasibilityChecker throws.
  CandidateGeneration(const SurfaceModel& model, const GenerationConfig& config,
                      const ExecConfig& exec);

  /// Poses of the sets and boundary views that are feasible according to the rules of ViewProposer.
  /// Throws whatever boundary_views() throws.
  Proposal generate(const Pose& T_world_camera) override;

  /// The feasible poses of one set.
  [[nodiscard]] Proposal propose_these(const PoseSet& set);

  /// The settings.
  [[nodiscard]] const GenerationConfig& config() const noexcept { return config_; }

  /// Boundary runs and patches behind the boundary candidates of the last proposal. The `number` of
  /// a candidate with a class is its index in estimated().candidates; the `number` of a set's
  /// candidate is its index in the set.
  [[nodiscard]] const EstimatedViews& estimated() const noexcept {
    return boundaries_->estimated();
  }
  /// Dropped candidates of the last proposal, in order, each with its reason.
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
