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

/// Settings of a ViewPlanner that its ScorerConfig does not have.
struct VIEWGAIN_EXPORT PlannerConfig {
  ReachRegion reach{};  ///< where the camera may be; a list of poses in it adds candidates
  ReachRegion::Tolerance taken_tolerance{};                    ///< when two poses are the same
  double max_near_share = FeasibilityConfig{}.max_near_share;  ///< as in FeasibilityConfig
  /// False: do not check body, obstacles and reach. Poses taken or tried are still left out.
  bool check_feasibility = true;
  /// If PlanAhead::is_on(), rank() of a proposal plans PlanAhead::plan views. propose() then
  /// returns the rest of the plan.
  PlanAhead ahead{};
  std::size_t max_views = PlanningConfig{}.max_views;    ///< as in PlanningConfig
  std::size_t idle_views = PlanningConfig{}.idle_views;  ///< as in PlanningConfig
  /// As in PlanningConfig. Counts only views taken at the best pose of the last ranking.
  std::size_t broken_promises = PlanningConfig{}.broken_promises;
  /// As in PlanningConfig [nat, m² for trace]; for the paper's gain only. See set_stop_rules().
  std::optional<double> stop_gain{};
  /// As in PlanningConfig; for the other gains only. The surface so far is the sum of
  /// MapUpdate::new_area over the views. See set_stop_rules() for the default.
  std::optional<double> stop_area{};
};

/// What a view brought.
struct VIEWGAIN_EXPORT AddedView {
  std::size_t view = 0;        ///< from 0; those that brought nothing count
  MapUpdate update{};          ///< of the map
  ModelProgress progress{};    ///< after it; surface_area: the sum of new areas so far [m²]
  double entropy_removed = 0;  ///< by this view [nat, or m² for trace]
};

/// Next-best views, step by step: frames in, views out. It runs Algorithm 1 one step per call. To a
/// ViewScorer it adds candidates, reach, stopping rules and a record of the poses tried.
///
/// One cycle: add() a frame, propose() candidates, rank() them and ask should_stop(). Then move the
/// camera, report the result with tried(), and add() the next frame. If reported poses are inexact,
/// add() each frame at the pose that register_frame() finds. With PlannerConfig::ahead, rank()
/// plans several views. propose() then returns the rest of the plan, until PlanAhead::take views
/// are taken.
///
/// A call that throws Error(invalid_argument) changes nothing. Exceptions from user code (a
/// generation, the reach predicate, a measure) pass through propose() and rank(). Thread safety:
/// one call at a time. Deterministic for any number of threads. A moved-from planner can only be
/// assigned to or destroyed. Costs: add() as ViewScorer::add(); propose() as
/// FeasibilityChecker::check() of the candidates, and the generations; rank() as
/// GainEvaluator::race() or best(); register_frame() as fused_points() and FrameAlignment.
/// @code
/// ViewPlanner planner(ViewScorer(sensor, {.voxel_size = 0.005, .workspace = box}));
/// planner.add_poses({"dome", dome_poses(500, 0.6)});
/// planner.add(frame, T_world_camera);
/// planner.propose();
/// const Ranking next = planner.rank();
/// @endcode
class VIEWGAIN_EXPORT ViewPlanner {
 public:
  /// `scorer`: an empty one or, to continue from a map, one with a map. Throws
  /// Error(invalid_argument), naming the value, for settings out of their range.
  explicit ViewPlanner(ViewScorer scorer, const PlannerConfig& config = {});
  ~ViewPlanner();
  ViewPlanner(ViewPlanner&&) noexcept;
  ViewPlanner& operator=(ViewPlanner&&) noexcept;

  /// A fixed set of candidates, proposed from the next propose() on; the last one is void. Throws
  /// Error(invalid_argument) for a pose that is not rigid (1e-3).
  void add_poses(PoseSet set);
  /// Candidates that are made anew for each proposal, say at the boundaries of the surface
  /// (BoundaryGeneration of viewgain::planner_mesh). Not part of what save() keeps.
  void add_generation(std::shared_ptr<ViewpointGeneration> generation);

  /// Where the camera was, by what the frame shows of the map so far: see FrameAlignment. Changes
  /// nothing. A frame that is registered is best put in at the pose that was found, one that is
  /// refused not at all, one of which the map shows too little as reported. Throws
  /// Error(invalid_argument) as FrameAlignment::register_frame().
  [[nodiscard]] FrameRegistration register_frame(const DepthFrame& frame, const Pose& T_reported,
                                                 const PoseSigma& sigma = kUsualPoseSigma) const;

  /// Puts a frame into the map and brings the scene up to date; the last proposal is void. What
  /// became of it AddedView::update says by its verdict: a frame that cannot be used leaves the map
  /// as it was, counts as a view that brought nothing, and its pose, if it is one, is tried. Throws
  /// Error(invalid_argument) for a pose_sigma that is none. Error(capacity) and Error(backend) are
  /// those of VoxelScene::build(): the frame is in the map then, the scene is the one before.
  /// DepthFrame::known_depth is set anew by the planner's obstacles. `pose_sigma` [m], [rad] is
  /// what the pose may be off beside the sensor's own pose_sigma, after register_frame() what
  /// FrameRegistration::pose_sigma() says.
  AddedView add(const DepthFrame& frame, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});
  /// The same of several frames from one pose; there must be one.
  AddedView add(std::span<const DepthFrame> frames, const Pose& T_world_camera,
                const PoseSigma& pose_sigma = {});

  /// A view that came to nothing before there was a frame to add, or whose frame is left out: it
  /// counts as add() counts one that cannot be used. `T_world_camera`: where it was taken, if that
  /// is known. Throws Error(invalid_argument) for a verdict of frames in the map.
  AddedView drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera = {});
  /// What became of the frames so far.
  [[nodiscard]] const FrameCounts& frames() const noexcept;

  /// The candidates of the reach region's poses, the sets and the generations, in this order, that
  /// are possible now by the rules of ViewProposer, and how many are not and why. Valid until the
  /// next add() or propose(). While views of a plan are left that are possible and still promise
  /// enough, these alone, by kPlanned. An earlier ranking since the last view is void. Throws
  /// Error(invalid_argument), as rank() does, if there were frames and none could be used: the
  /// map says nothing, and what is wrong with the set-up would not be noticed.
  const Proposal& propose();
  /// Behind the last proposal, in the order of the candidates, and valid as long.
  [[nodiscard]] const std::vector<DroppedCandidate>& dropped() const noexcept;
  /// Of the last proposal; 0 without one since the last view.
  [[nodiscard]] std::size_t candidate_count() const noexcept;

  /// The k best of the proposal, fewer if there are fewer; without a measure of the user's own
  /// those that gain nothing are left out, so none is an answer, too. Ties go to the earlier
  /// candidate. With a plan ahead the next k of its views, in its order; it is the same for any k,
  /// and goes by the gain alone. Paths start at RankConfig::current_pose. Default: the pose
  /// of the last frame, usable or not, or of a later tried() that was reached; a lost pose changes
  /// nothing. Throws Error(invalid_argument) without a proposal
  /// since the last view, and as rank_views().
  [[nodiscard]] Ranking rank(std::size_t k = 1, const RankConfig& config = {},
                             const BatchControl& control = {});
  /// The same of any poses, `T_world_camera` in any order; nobody looks whether they are possible.
  /// Bad ones are left out. Says nothing to should_stop().
  [[nodiscard]] Ranking rank(std::span<const Pose> T_world_camera, std::size_t k = 1,
                             const RankConfig& config = {}, const BatchControl& control = {});

  /// The pose was commanded. `reached`: did the camera get there? It counts as taken then, else as
  /// missed. In both cases it is not proposed again, and goes out of the proposal as it stands,
  /// whose later candidates move up. Call it only for poses that were commanded. Throws
  /// Error(invalid_argument) for a pose that is not rigid (1e-3).
  void tried(const Pose& T_world_camera, bool reached);

  /// Why to end, if there is a reason: after add() max_views, idle or promises; after propose()
  /// no_candidates or unreachable; after rank() of the proposal gain, area or, with costs, cost: no
  /// view is worth its way. The last ranking of a view counts.
  [[nodiscard]] std::optional<StopReason> should_stop() const noexcept;

  /// The whole state in one file: a map that every program reads, with the rest in its note
  /// "planner". Left out are what the constructor got, sets, generations and the last proposal.
  /// Atomic: after a kill at any moment the file is the one before or this one. Throws Error(io).
  void save(const std::filesystem::path& path) const;
  /// Continues where save() was called. With the same settings, sets and generations every later
  /// answer has the same bits, from the next propose(), add() or rank() of given poses on. Throws
  /// as the constructors; Error(invalid_argument) if the map has another layout than scorer.grid(),
  /// or has grown since by other means than add(); Error(format) for a file of another kind; and as
  /// load_vdb().
  [[nodiscard]] static ViewPlanner load(const std::filesystem::path& path, const Sensor& sensor,
                                        const ScorerConfig& scorer, const PlannerConfig& config,
                                        const ExecConfig& exec = {});

  /// What the last rank() of the proposal decided on, for Algorithm 1; nothing: none will do.
  [[nodiscard]] const std::optional<DecisionMaking::Decision>& decision() const noexcept;
  /// When a run by these settings ends, for active_view_planning().
  [[nodiscard]] const PlanningConfig& planning() const noexcept;
  /// The map, its scene and its evaluator. Its address stays the same when the planner is moved.
  [[nodiscard]] const ViewScorer& scorer() const noexcept;
  /// What the steps since the last add() took, it included: integrate, snapshot, candidates, score.
  [[nodiscard]] const StageSeconds& seconds() const noexcept;

 private:
  struct Impl;
  explicit ViewPlanner(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
