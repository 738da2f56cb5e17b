// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain {

/// A ViewPlanner as the parts of Algorithm 1 in Foix et al. (2012). active_view_planning(start,
/// camera, parts, parts, parts, planner.planning()) takes the same views as a loop of add(),
/// propose() and rank(). Thread safety and cost are those of these calls.
/// @code
/// ViewPlanner planner(ViewScorer(sensor, {.voxel_size = 0.01, .workspace = box}));
/// planner.add_poses({"sphere", poses});
/// PlannerParts parts(planner);
/// parts.update({T_world_camera, {frame}});
/// const Proposal proposal = parts.generate(T_world_camera);
/// const std::size_t next = parts.decide(T_world_camera, proposal.candidates)->candidate;
/// const Pose& there = proposal.candidates[next].T_world_camera;
/// @endcode
class VIEWGAIN_EXPORT PlannerParts final : public RepresentationUpdate,
                                           public ViewpointGeneration,
                                           public DecisionMaking {
 public:
  /// Keeps a reference to the planner. `config`: as in ViewPlanner::rank(); paths start at the
  /// camera pose that the loop passes.
  explicit PlannerParts(ViewPlanner& planner, const RankConfig& config = {})
      : planner_(planner), config_(config) {}

  /// ViewPlanner::add().
  ModelProgress update(const Measurements& measurements) override;
  /// ViewPlanner::propose().
  Proposal generate(const Pose& T_world_camera) override;
  /// ViewPlanner::rank(); `candidates` must come from the last generate().
  std::optional<Decision> decide(const Pose& T_world_camera,
                                 std::span<const Candidate> candidates) override;

 private:
  ViewPlanner& planner_;
  RankConfig config_;
};

}  // namespace viewgain
