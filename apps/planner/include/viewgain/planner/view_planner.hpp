// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain {

/// Settings of a ViewPlanner in addition to ScorerConfig.
struct VIEWGAIN_EXPORT PlannerConfig {
  ReachRegion reach{};  ///< reachable camera poses; a list of poses in it adds candidates
  ReachRegion::Tolerance taken_tolerance{};  ///< tolerance for two poses to be the same
  double max_near_share = FeasibilityConfig{}.max_near_share;  ///< as in FeasibilityConfig
  /// False: ignores body, obstacles and reach. Poses taken or tried are still omitted.
  bool check_feasibility = true;
  /// If PlanAhead::is_on(), rank() of a proposal plans PlanAhead::plan views, and propose() then
  /// returns the rest of the plan.
  PlanAhead ahead{};
  std::size_t max_views = PlanningConfig{}.max_views;    ///< as in PlanningConfig
  std::size_t idle_views = PlanningConfig{}.idle_views;  ///< as in PlanningConfig
  /// As in PlanningConfig. Counts only views taken at the best pose of the last ranking.
  std::size_t broken_promises = PlanningConfig{}.broken_promises;
  /// As in PlanningConfig [nat, m² for trace]; only for the paper's gain. See set_stop_rules().
  std::optional<double> stop_gain{};
  /// As in PlanningConfig; only for the other gains. The surface so far is the sum of
  /// MapUpdate::new_area over the views. See set_stop_rules() for the default.
  std::optional<double> stop_area{};
};

/// Result of a view.
struct VIEWGAIN_EXPORT AddedView {
  std::size_t view = 0;        ///< from 0, including views that brought nothing
  MapUpdate update{};          ///< update of the map
  ModelProgress progress{};    ///< state after it; surface_area: the sum of new areas so far [m²]
  double entropy_removed = 0;  ///< increase of the removed entropy [nat, or m² for trace]
};

/// Next-best views step by step: runs Algorithm 1 with one call per step. Adds candidates, reach,
/// stopping rules and a record of tried poses to a ViewScorer.
///
/// One cycle: add() a frame, propose() candidates, rank() them and ask should_stop(). Then move the
/// camera, report the result with tried(), and add() the next frame. If reported poses are inexact,
/// add() each frame at the pose from register_frame(). With PlannerConfig::ahead, rank() plans
/// several views, and propose() returns the rest of the plan until PlanAhead::take views are taken.
///
/// A call that throws Error(invalid_argument) changes nothing. Exceptions from user code (a
/// generation, the reach predicate, a measure) pass through propose() and rank(). Thread safety:
/// one call at a time. Deterministic for any number of threads. A moved-from planner can only be
/// assigned to or destroyed. Cost: add() as ViewScorer::add(); propose() as
/// FeasibilityChecker::check() and the generations; rank() as GainEvaluator::race() or best();
/// register_frame() as fused_points() and FrameAlignment.
/// @code
/// ViewPlanner planner(ViewScorer(sensor, {.voxel_size = 0.005, .workspace = box}));
/// planner.add_poses({"dome", dome_poses(500, 0.6)});
/// planner.add(frame, T_world_camera);
/// planner.propose();
/// const Ranking next = planner.rank();
/// @endcode
class VIEWGAIN_EXPORT ViewPlanner {
 public:
  /// `scorer`: with an empty map, or with a map to continue. Throws Error(invalid_argument) naming
  /// the value for settings out of range.
  explicit ViewPlanner(ViewScorer scorer, const PlannerConfig& config = {});
  ~ViewPlanner();
  ViewPlanner(ViewPlanner&&) noexcept;
  ViewPlanner& operator=(ViewPlanner&&) noexcept;

  /// Adds a fixed set of candidates for all later calls of propose(); invalidates the last
  /// proposal. Throws Error(invalid_argument) for a pose that is not rigid (1e-3).
  void add_poses(PoseSet set);
  /// Adds candidates that are recomputed for each proposal, such as those at surface boundaries
  /// (BoundaryGeneration of viewgain::planner_mesh). save() does not include it.
  void add_generation(std::shared_ptr<ViewpointGeneration> generation);

  /// Estimates the camera pose from the frame and the map; see FrameAlignment. Changes nothing. Add
  /// a registered frame at the estimated pose, a frame with too little overlap as reported, and a
  /// refused frame not at all. Throws Error(invalid_argument) as FrameAlignment::register_frame().
  [[nodiscard]] FrameRegistration register_frame(const DepthFrame& frame, const Pose& T_reported,
                                                 const PoseSigma& sigma = kUsualPoseSigma) const;

  /// Integrates a frame and updates the scene; invalidates the last proposal. The verdict in
  /// AddedView::update gives the outcome: a frame that cannot be used leaves the map unchanged and
  /// counts as a view that brought nothing, with its pose tried. The planner's obstacles replace
  /// DepthFrame::known_depth. `pose_sigma` [m], [rad] is the pose's uncertainty in addition to the
  /// sensor's; after register_frame() use FrameRegistration::pose_sigma(). Throws
  /// Error(invalid_argument) for an invalid pose_sigma; Error(capacity) and Error(backend) as
  /// VoxelScene::build(), with the frame in the map and the previous scene.
  AddedView add(const DepthFrame& frame, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});
  /// As above, for one or more frames from one pose.
  AddedView add(std::span<const DepthFrame> frames, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});

  /// Records a view that failed before there was a frame, or whose frame is left out; it counts as
  /// a frame that cannot be used in add(). `T_world_camera`: its pose, if known. Throws
  /// Error(invalid_argument) for the verdict of a frame in the map.
  AddedView drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera = {});
  /// Verdicts of the frames so far.
  [[nodiscard]] const FrameCounts& frames() const noexcept;

  /// Possible candidates from the reach region's poses, the sets and the generations, in this
  /// order, under the rules of ViewProposer, and the number of dropped ones by reason. While views
  /// of a plan are left that are possible and still promise enough, only these (generator
  /// kPlanned). Valid until the next add() or propose(). Invalidates earlier rankings since the
  /// last view. Throws Error(invalid_argument), as rank() does, if no frame so far could be used,
  /// because that points to a wrong set-up.
  const Proposal& propose();
  /// Details of the last proposal, in the order of the candidates; valid as long.
  [[nodiscard]] const std::vector<DroppedCandidate>& dropped() const noexcept;
  /// Number of candidates of the last proposal; 0 if there is none since the last view.
  [[nodiscard]] std::size_t candidate_count() const noexcept;

  /// The k best of the proposal, or fewer. Views with no gain are omitted unless a measure ranks
  /// them; the result may be empty. Ties go to the earlier candidate. With a plan ahead, the next k
  /// of its views, in its order; the plan does not depend on k and uses only the gain. Paths start
  /// at RankConfig::current_pose, by default the pose of the last frame, usable or not, or of a
  /// later tried() that was reached. Throws Error(invalid_argument) without a proposal since the
  /// last view, and as rank_views().
  [[nodiscard]] Ranking rank(std::size_t k = 1, const RankConfig& config = {},
                             const BatchControl& control = {});
  /// Ranks any poses, `T_world_camera`, without a check of feasibility. Omits invalid ones. Does
  /// not affect should_stop().
  [[nodiscard]] Ranking rank(std::span<const Pose> T_world_camera, std::size_t k = 1,
                             const RankConfig& config = {}, const BatchControl& control = {});

  /// Reports that the pose was commanded, and whether it was `reached`: then it counts as taken,
  /// otherwise as missed. Either way it is not proposed again and leaves the current proposal,
  /// whose later candidates move up. Throws Error(invalid_argument) for a pose that is not rigid
  /// (1e-3).
  void tried(const Pose& T_world_camera, bool reached);

  /// Reason to stop, if any: after add() max_views, idle or promises; after propose() no_candidates
  /// or unreachable; after rank() of the proposal gain, area or, with costs, cost. Uses the last
  /// ranking of a view.
  [[nodiscard]] std::optional<StopReason> should_stop() const noexcept;

  /// Saves the state in one file: a map for any program, with the rest in its note "planner". Omits
  /// the constructor's arguments, sets, generations and the last proposal. Atomic. Throws
  /// Error(io).
  void save(const std::filesystem::path& path) const;
  /// Continues after save(). With the same settings, sets and generations, all later results are
  /// bit-identical, starting with the next propose(), add() or rank() of given poses. Throws as the
  /// constructors; Error(invalid_argument) if the map's layout differs from scorer.grid(), or it
  /// grew by other means than add(); Error(format) for another kind of file; and as load_vdb().
  [[nodiscard]] static ViewPlanner load(const std::filesystem::path& path, const Sensor& sensor,
                                        const ScorerConfig& scorer, const PlannerConfig& config,
                                        const ExecConfig& exec = {});

  /// Decision of the last rank() of the proposal, for Algorithm 1; empty: no candidate is suitable.
  [[nodiscard]] const std::optional<DecisionMaking::Decision>& decision() const noexcept;
  /// Stopping rules of these settings, for active_view_planning().
  [[nodiscard]] const PlanningConfig& planning() const noexcept;
  /// The map with its scene and evaluator. Moving the planner does not change its address.
  [[nodiscard]] const ViewScorer& scorer() const noexcept;
  /// Duration of the steps since the last add(), including it: integrate, snapshot, candidates,
  /// score.
  [[nodiscard]] const StageSeconds& seconds() const noexcept;

 private:
  struct Impl;
  explicit ViewPlanner(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
