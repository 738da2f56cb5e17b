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
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner/rank_views.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner/view_proposer.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// What a planner is set up with, each setting in one place. The body that must have room is the
/// sensor's (Sensor::body_size, T_flange_camera; without a size FeasibilityConfig::Body's).
struct VIEWGAIN_EXPORT PlannerConfig {
  /// A workspace that begins at the table has no voxels under it that stay unknown, which the
  /// paper's gain would count.
  GridConfig grid{};
  /// How frames change the map. State support_plane in surroundings; another here is refused.
  IntegrationConfig integration{};
  Surroundings surroundings{};  ///< the table, known obstacles
  std::optional<JumpEdgeFilter::Config> jump_edges =
      JumpEdgeFilter::Config{};  ///< nothing: frames are taken as is
  HazardConfig hazard{};         ///< of unknown space
  GainConfig gain{};             ///< what ranks views
  /// Where it is on, rank() of a proposal plans that many views, and propose() names what is left
  /// of the plan while there is any.
  PlanAhead ahead{};
  ReachRegion reach{};   ///< its list of poses, if it has one, is among the candidates
  double clearance = 0;  ///< round the body [m]
  ReachRegion::Tolerance taken_tolerance{};                    ///< when two poses are the same
  double max_near_share = FeasibilityConfig{}.max_near_share;  ///< as there
  /// False: every candidate is possible but those that were taken or tried.
  bool check_feasibility = true;
  /// The rules of PlanningConfig; there is no coverage, and nobody asks its stop token.
  std::size_t max_views = PlanningConfig{}.max_views;
  std::size_t idle_views = PlanningConfig{}.idle_views;  ///< PlanningConfig's
  /// PlanningConfig's, of views that were taken from where the best of the last ranking was.
  std::size_t broken_promises = PlanningConfig{}.broken_promises;
  std::optional<double> stop_gain{};  ///< [nat, m² for trace]; set_stop_rules() has both defaults
  /// A share of the surface so far: of the sum of what the views showed of new surface.
  std::optional<double> stop_area{};
};

/// What a view brought.
struct VIEWGAIN_EXPORT AddedView {
  std::size_t view = 0;        ///< from 0; those that brought nothing count
  MapUpdate update{};          ///< of the map
  ModelProgress progress{};    ///< after it; surface_area: the sum of new areas so far [m²]
  double entropy_removed = 0;  ///< by this view [nat, or m² for trace]
};

/// Next best views for a robot's program that calls step by step: frames in, views out. The steps
/// of Algorithm 1 without its loop.
///
/// add() a frame, where reported poses are inexact at the one that register_frame() finds;
/// propose() candidates; rank() them; ask should_stop(), which counts what they promise; move, and
/// say how that went with tried(); add() the next frame. With PlannerConfig::ahead rank() plans
/// some views, and propose() names what is left of the plan until its share is taken.
///
/// What is refused (Error(invalid_argument)) has changed nothing. What the user's own parts throw,
/// a generation, the reach region's predicate or a measure, passes through propose() and rank().
/// Thread safety: one call at a time. Deterministic, for any number of threads. One that was moved
/// from can only be assigned to or destroyed. Cost of a step: that of its parts, add()
/// MapModel::update(), propose() FeasibilityChecker::check() of the candidates and what generations
/// take, rank() GainEvaluator::race() or best(), register_frame() fused_points() and
/// FrameAlignment, save() and load() save_vdb() and load_vdb().
class VIEWGAIN_EXPORT ViewPlanner {
 public:
  /// Throws Error(invalid_argument), naming the value, for settings out of their range.
  ViewPlanner(const Sensor& sensor, const PlannerConfig& config, const ExecConfig& exec = {});
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
  /// Goes on where save() was called: with the same constructor's arguments, sets and generations
  /// every later answer has the same bits, from the next propose(), add() or rank() of given poses
  /// on. Throws as the constructor, Error(invalid_argument) if the map is laid out otherwise than
  /// config.grid says or has grown since by other means than add(), Error(format) for a file of
  /// another kind, and as load_vdb().
  [[nodiscard]] static ViewPlanner load(const std::filesystem::path& path, const Sensor& sensor,
                                        const PlannerConfig& config, const ExecConfig& exec = {});

  /// Stays where it is when the planner is moved, and goes with it.
  [[nodiscard]] const MapModel& map() const noexcept;
  /// The map.
  [[nodiscard]] const BeliefGrid& grid() const noexcept;
  /// Of the scene as it is now. Valid until the next add().
  [[nodiscard]] const GainEvaluator& evaluator();
  /// What the steps since the last add() took, it included: integrate, snapshot, candidates, score.
  [[nodiscard]] const StageSeconds& seconds() const noexcept;

 private:
  struct Impl;
  explicit ViewPlanner(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
