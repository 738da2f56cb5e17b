// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

/// @file
/// Rules that decide which candidates are feasible. All commands, studies, ViewPlanner and Python
/// share these rules. Poses are T_world_camera. Functions keep the order of the poses.

namespace viewgain {

/// Reason for dropping a candidate that was tried and not reached.
inline constexpr std::string_view kMissed = "missed";

/// A dropped candidate.
struct VIEWGAIN_EXPORT DroppedCandidate {
  Candidate candidate;  ///< the candidate
  std::string reason;   ///< infeasibility_name() or kMissed
};

/// The poses of the candidates, in order.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> poses_of(std::span<const Candidate> candidates);

/// Settings of a ViewProposer.
struct VIEWGAIN_EXPORT ProposerConfig {
  FeasibilityConfig feasibility{};  ///< feasibility, and tolerance for taken poses
  /// False: accepts all candidates except those taken or tried.
  bool check_feasibility = true;
  /// If the reach is limited and there are generations, adds 1,200 candidates of
  /// reachable_hazard_views() at about this distance [m]; 0: none.
  double distance_in_reach = 0;
};

/// Collects candidates of sets and generations, and checks which of them are feasible. If all views
/// of the map lie inside its workspace, as in a room, candidates of generations must lie inside as
/// well, because obstacles outside are not mapped. This rule does not apply if the reach is
/// limited. Not thread safe.
class VIEWGAIN_EXPORT ViewProposer {
 public:
  /// The reach region's list of poses, if any, becomes the set "reach". Throws whatever
  /// FeasibilityChecker throws.
  ViewProposer(std::shared_ptr<const VoxelScene> scene, ProposerConfig config,
               const ExecConfig& exec = {});

  /// Adds a fixed set of candidates.
  void add_poses(PoseSet set);
  /// Adds candidates that are recomputed for each proposal.
  void add_generation(std::shared_ptr<ViewpointGeneration> generation);

  /// The feasible candidates of the sets, then those of the generations, in order. Also gives the
  /// number of dropped candidates per reason. `scene` must show the current map. Poses in `reached`
  /// and `missed` were tried and are dropped. Generations receive the current camera pose
  /// `T_world_camera`. Cost: the generations, and FeasibilityChecker::check().
  [[nodiscard]] Proposal propose(const BeliefGrid& grid, std::shared_ptr<const VoxelScene> scene,
                                 const Pose& T_world_camera, std::span<const Pose> reached = {},
                                 std::span<const Pose> missed = {});

  /// The feasible poses of one set, according to the same rules.
  [[nodiscard]] Proposal propose_these(const PoseSet& set, const BeliefGrid& grid,
                                       std::shared_ptr<const VoxelScene> scene,
                                       std::span<const Pose> reached = {},
                                       std::span<const Pose> missed = {});

  /// Details of the last proposal, in the order of the candidates.
  [[nodiscard]] const std::vector<DroppedCandidate>& dropped() const noexcept { return dropped_; }

  /// Reports a tried pose. Candidates at this pose are removed from `proposal` and added to
  /// dropped(), with `reason`.
  void drop(const Pose& tried, std::string_view reason, Proposal& proposal);

 private:
  /// Adds the possible candidates to the proposal; those from index `of_sets` on come from
  /// generations.
  void keep_possible(std::vector<Candidate> candidates, std::size_t of_sets, const BeliefGrid& grid,
                     std::span<const Pose> reached, std::span<const Pose> missed,
                     Proposal& proposal);
  [[nodiscard]] bool draws_from_reach() const;
  [[nodiscard]] bool stays_inside(const BeliefGrid& grid) const;

  ProposerConfig config_;
  FeasibilityChecker checker_;
  std::vector<PoseSet> sets_;
  std::vector<std::shared_ptr<ViewpointGeneration>> generations_;
  std::vector<DroppedCandidate> dropped_;
};

}  // namespace viewgain
