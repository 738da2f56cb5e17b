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
  /// Settings for planning several views. If PlanAhead::is_on(), rank() of a proposal plans several
  /// views, and later calls of propose() return the views that are left.
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
  std::size_t view = 0;  ///< number of the view, from 0, counting failed views
  MapUpdate update{};    ///< update of the map
  /// State after the view; surface_area is the sum of new areas so far [m²].
  ModelProgress progress{};
  double entropy_removed = 0;  ///< increase of the removed entropy [nat, or m² for trace]
};

/// Plans next-best views step by step. Each call is one step of Algorithm 1 in Foix et al. (2012).
/// A ViewPlanner consists of a ViewScorer, candidates, a reach, stopping rules and a record of
/// tried poses.
///
/// One cycle: add() a frame, propose() candidates, rank() them and ask should_stop(). Then move the
/// camera, report the result with tried(), and add() the next frame. If reported poses are inexact,
/// add() each frame at the pose from register_frame(). PlannerConfig::ahead plans several views at
/// once.
///
/// A call that throws Error(invalid_argument) changes nothing. Exceptions from user code (a
/// generation, the reach predicate, a measure) pass through propose() and rank(). Thread safety:
/// one call at a time. Deterministic for any number of threads. A moved-from planner can only be
/// assigned to or destroyed. The cost of each step is that of the call behind it:
/// ViewScorer::add(), FeasibilityChecker::check(), GainEvaluator::race() and FrameAlignment.
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
  /// proposal. Throws Error(invalid_argument) for a pose that is not rigid to within 1e-3.
  void add_poses(PoseSet set);
  /// Adds candidates that are recomputed for each proposal, such as those at surface boundaries
  /// (BoundaryGeneration of viewgain::planner_mesh). save() does not include the generation.
  void add_generation(std::shared_ptr<ViewpointGeneration> generation);

  /// Estimates the camera pose from the frame and the map; see FrameAlignment. Changes nothing. If
  /// the frame is registered, add() it at the estimated pose; with too little overlap, at the
  /// reported pose; if it is refused, drop() it. Throws whatever FrameAlignment::register_frame()
  /// throws.
  [[nodiscard]] FrameRegistration register_frame(const DepthFrame& frame, const Pose& T_reported,
                                                 const PoseSigma& sigma = kUsualPoseSigma) const;

  /// Integrates a frame and updates the scene; invalidates the last proposal. If a frame cannot be
  /// used, AddedView::update gives the reason, and the map stays unchanged; the frame counts as a
  /// failed view, and its pose as tried. DepthFrame::known_depth is recomputed from the obstacles.
  /// `pose_sigma` [m], [rad] is combined with the sensor's; after register_frame() use
  /// FrameRegistration::pose_sigma(). Throws Error(invalid_argument) if it is invalid. Also throws
  /// whatever VoxelScene::build() throws.
  AddedView add(const DepthFrame& frame, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});
  /// As above, for one or more frames from one pose.
  AddedView add(std::span<const DepthFrame> frames, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});

  /// Records a view without a usable frame, like add() with a frame that cannot be used.
  /// `T_world_camera`: its pose, if known. Throws Error(invalid_argument) if `verdict` means that
  /// the frame is in the map.
  AddedView drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera = {});
  /// Verdicts of the frames so far.
  [[nodiscard]] const FrameCounts& frames() const noexcept;

  /// The feasible candidates: first the reach region's poses, then those of the sets and of the
  /// generations (see ViewProposer). Also gives the number of dropped candidates per reason. If an
  /// earlier plan has views left that are still feasible and worth taking, returns only these;
  /// their generator is kPlanned. Valid until the next add() or propose(). Earlier rankings become
  /// invalid. Like rank(), throws Error(invalid_argument) if no frame so far could be used, because
  /// the set-up is then probably wrong.
  const Proposal& propose();
  /// Dropped candidates of the last proposal, in order; valid as long as the proposal.
  [[nodiscard]] const std::vector<DroppedCandidate>& dropped() const noexcept;
  /// Number of candidates of the last proposal; 0 if there is none since the last view.
  [[nodiscard]] std::size_t candidate_count() const noexcept;

  /// The k best of the proposal, or fewer. Views with no gain are omitted unless a measure ranks
  /// them, so the result may be empty. Ties go to the earlier candidate. If views of a plan are
  /// left, the result is the plan's next k views, in the plan's order. Paths start at
  /// RankConfig::current_pose; by default this is the pose of the last frame, or of a later tried()
  /// that was reached. Throws Error(invalid_argument) if propose() was not called since the last
  /// view. Also throws whatever rank_views() throws.
  [[nodiscard]] Ranking rank(std::size_t k = 1, const RankConfig& config = {},
                             const BatchControl& control = {});
  /// Ranks any poses, `T_world_camera`, without a check of feasibility. Omits invalid ones. Does
  /// not affect should_stop().
  [[nodiscard]] Ranking rank(std::span<const Pose> T_world_camera, std::size_t k = 1,
                             const RankConfig& config = {}, const BatchControl& control = {});

  /// Reports whether a commanded pose was `reached`. The pose is not proposed again. It is also
  /// removed from the current proposal, so the indices of later candidates decrease. Throws
  /// Error(invalid_argument) for a pose that is not rigid to within 1e-3.
  void tried(const Pose& T_world_camera, bool reached);

  /// Reason to stop, if any. After add() it can be max_views, idle or promises; after propose()
  /// no_candidates or unreachable; after rank() gain, area or, with costs, cost. If rank() is
  /// called several times, the last ranking counts.
  [[nodiscard]] std::optional<StopReason> should_stop() const noexcept;

  /// Saves the state in one file. The file is a map that other programs can read; its note
  /// "planner" contains the rest of the state. Not saved are the constructor's arguments, sets,
  /// generations and the last proposal. Atomic. Throws Error(io).
  void save(const std::filesystem::path& path) const;
  /// Continues after save(). With the same settings, sets and generations, all later results are
  /// bit-identical. Throws Error(invalid_argument) if the map's layout differs from scorer.grid(),
  /// or if functions other than add() changed the map. Throws Error(format) if save() did not write
  /// the file. Also throws whatever the constructors and load_vdb() throw.
  [[nodiscard]] static ViewPlanner load(const std::filesystem::path& path, const Sensor& sensor,
                                        const ScorerConfig& scorer, const PlannerConfig& config,
                                        const ExecConfig& exec = {});

  /// The decision of the last rank() of the proposal, as used by Algorithm 1; empty if no candidate
  /// is suitable.
  [[nodiscard]] const std::optional<DecisionMaking::Decision>& decision() const noexcept;
  /// Stopping rules of these settings, for active_view_planning().
  [[nodiscard]] const PlanningConfig& planning() const noexcept;
  /// The map with its scene and evaluator. Moving the planner does not change its address.
  [[nodiscard]] const ViewScorer& scorer() const noexcept;
  /// Duration of the steps since the last add(), including that call: integrate, snapshot,
  /// candidates, score.
  [[nodiscard]] const StageSeconds& seconds() const noexcept;

 private:
  struct Impl;
  explicit ViewPlanner(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
