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
/// Which views are possible, by one set of rules for all that propose: the program's next,
/// model, reconstruct and score --feasible, studies, ViewPlanner, C and Python. Poses are
/// T_world_camera. Functions keep the order of the poses.

namespace viewgain {

/// Why a candidate is dropped that was commanded and not reached.
inline constexpr std::string_view kMissed = "missed";

/// A candidate that was not proposed.
struct VIEWGAIN_EXPORT DroppedCandidate {
  Candidate candidate;  ///< who was dropped
  std::string reason;   ///< infeasibility_name() or kMissed
};

/// Their poses, in the same order.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> poses_of(std::span<const Candidate> candidates);

/// What a ViewProposer lets through.
struct VIEWGAIN_EXPORT ProposerConfig {
  FeasibilityConfig feasibility{};  ///< what is possible, and what is taken
  /// False: every candidate is possible but those that were taken or tried.
  bool check_feasibility = true;
  /// If the reach is limited, 1,200 reachable_hazard_views() from this distance [m] are added to
  /// the candidates of generations; 0: none.
  double distance_in_reach = 0;
};

/// Candidates of sets and generations, and which of them are possible. Where the map's views were
/// all taken inside its workspace, as in a room, and the region of reach is empty, generations'
/// candidates stay inside it: nothing outside is mapped, so nothing there would be in the camera's
/// way. Not thread safe.
class VIEWGAIN_EXPORT ViewProposer {
 public:
  /// The poses of the region of reach, if it has a list, are the set "reach". Throws as
  /// FeasibilityChecker.
  ViewProposer(std::shared_ptr<const VoxelScene> scene, ProposerConfig config,
               const ExecConfig& exec = {});

  /// A fixed set of candidates.
  void add_poses(PoseSet set);
  /// Candidates that are made anew for each proposal.
  void add_generation(std::shared_ptr<ViewpointGeneration> generation);

  /// The candidates of the sets and then of the generations, each in their order, that are possible
  /// in `scene`, which is the map's, now that `reached` and `missed` were tried; how many are not,
  /// and why. `T_world_camera` is where the camera is, which generations are told. Costs as the
  /// generations and FeasibilityChecker::check().
  [[nodiscard]] Proposal propose(const BeliefGrid& grid, std::shared_ptr<const VoxelScene> scene,
                                 const Pose& T_world_camera, std::span<const Pose> reached = {},
                                 std::span<const Pose> missed = {});

  /// Those of a set alone that are possible, by the same rules.
  [[nodiscard]] Proposal propose_these(const PoseSet& set, const BeliefGrid& grid,
                                       std::shared_ptr<const VoxelScene> scene,
                                       std::span<const Pose> reached = {},
                                       std::span<const Pose> missed = {});

  /// Behind the last proposal, in the order of the candidates.
  [[nodiscard]] const std::vector<DroppedCandidate>& dropped() const noexcept { return dropped_; }

  /// The pose was tried: what is the same view goes from `proposal` to the dropped, by `reason`.
  void drop(const Pose& tried, std::string_view reason, Proposal& proposal);

 private:
  /// Puts those that are possible into the proposal; the ones from `of_sets` on are of generations.
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
