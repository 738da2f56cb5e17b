// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/planner_mesh/boundary_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {

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
