// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/view_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "choose/planner_state.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/planner/stop_settings.hpp"
#include "viewgain/support/stop_rules.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr const char* kNote = "planner";  // the note with the state in the saved map

void check_rigid(const Pose& pose, const char* what) {
  if (!rigid_pose(pose)) refuse(std::string(what) + " is not a rigid transform of finite numbers");
}

std::string layout_text(const BeliefGrid& grid) {
  const Box box = grid.workspace();
  std::string text = "voxels of " + short_text(grid.voxel_size()) + " m, prior sigma " +
                     short_text(grid.prior_sigma()) + " m, workspace";
  for (const auto& corner : {box.min, box.max}) {
    for (const double value : corner) text.append(" ").append(short_text(value));
  }
  return text;
}

std::optional<StopReason> limit_reached(const PlanningConfig& limits, const StopMemory& memory) {
  if (memory.views == 0) return std::nullopt;
  if (memory.views >= limits.max_views) return StopReason::max_views;
  if (limits.idle_views > 0 && memory.idle_views >= limits.idle_views) return StopReason::idle;
  const bool is_broken =
      limits.broken_promises > 0 && memory.broken_promises >= limits.broken_promises;
  return is_broken ? std::optional(StopReason::promises) : std::nullopt;
}

// The planner's settings for its parts.

ProposerConfig proposer_config(const PlannerConfig& config, const ViewScorer& scorer) {
  FeasibilityConfig feasibility = feasibility_of(scorer.sensor());
  feasibility.clearance = scorer.config().clearance;
  feasibility.reach = config.reach;
  feasibility.taken_tolerance = config.taken_tolerance;
  feasibility.max_near_share = config.max_near_share;
  return {std::move(feasibility), config.check_feasibility, scorer.sensor().working_distance};
}

PlanningConfig planning_config(const PlannerConfig& config, const GainConfig& gain) {
  PlanningConfig planning;
  planning.max_views = config.max_views;
  planning.idle_views = config.idle_views;
  planning.broken_promises = config.broken_promises;
  set_stop_rules(planning, gain.model, gain.criterion, config.stop_gain, config.stop_area);
  return planning;
}

}  // namespace

struct ViewPlanner::Impl {
  PlannerConfig config;
  ViewScorer scorer;
  PlanningConfig planning;
  detail::PlannerState state;
  ViewProposer proposer;
  std::optional<Proposal> proposal;
  bool is_of_plan = false;                           // the proposal
  std::optional<DecisionMaking::Decision> decision;  // the last one
  StageSeconds seconds;
  std::once_flag is_registering;
  std::optional<FrameAlignment> registration;  // computed on demand

  Impl(ViewScorer by, const PlannerConfig& with)
      : config(with),
        scorer(std::move(by)),
        planning(planning_config(with, scorer.config().gain)),
        proposer(scorer.scene(), proposer_config(with, scorer), scorer.exec()) {
    (void)StopRules(planning);  // rejects invalid settings
    config.ahead.check();
  }

  // For an initial map: its contents do not count as the first view's.
  void begin() {
    const std::vector<Pose>& views = scorer.grid().views();
    const ModelProgress progress = scorer.progress();
    state.first_views = views.size();
    if (!views.empty()) state.last_pose = views.back();
    state.after_choice.entropy_removed = progress.entropy_removed;
    if (!views.empty()) state.after_choice.unknown_voxels = progress.unknown_voxels;
    state.before_choice = state.after_choice;
  }

  // Result of a finished view.
  AddedView counted(MapUpdate update, const std::optional<Pose>& T_world_camera) {
    AddedView added;
    added.view = state.after_choice.views;
    const double before = state.after_choice.entropy_removed;
    added.update = std::move(update);
    added.progress = scorer.progress();
    ++state.frames[added.update.verdict];
    if (is_in_map(added.update.verdict)) {
      // Without learn_hazard the area is not needed.
      if (!std::isnan(added.update.new_area)) state.seen_area += added.update.new_area;
    } else if (T_world_camera && rigid_pose(*T_world_camera)) {
      state.reached.push_back(*T_world_camera);
    }
    added.progress.surface_area = state.seen_area;
    added.progress.new_area = is_in_map(added.update.verdict) ? added.update.new_area : 0.0;
    added.entropy_removed = added.progress.entropy_removed - before;
    seconds = added.update.seconds;
    proposal.reset();
    if (T_world_camera && rigid_pose(*T_world_camera)) state.last_pose = T_world_camera;
    pass_planned(T_world_camera);
    forget_promise_unless_kept_at(T_world_camera);
    StopRules rules(planning, state.after_choice);
    state.of_view = rules.after_view(added.progress);
    state.of_choice.reset();
    state.before_choice = state.after_choice = rules.memory();
    // If the current pose was unknown, the path has not begun.
    const bool has_pose =
        std::any_of(state.frames.begin(), state.frames.end(), [](const auto& counted) {
          return counted.first != FrameVerdict::lost_pose && counted.first != FrameVerdict::no_pose;
        });
    if (!has_pose) {
      if (state.of_view == StopReason::idle) state.of_view.reset();
      state.before_choice.idle_views = state.after_choice.idle_views = 0;
    }
    return added;
  }

  // The view is one of the plan, or replaces the plan's next view.
  void pass_planned(const std::optional<Pose>& T_world_camera) {
    if (state.planned.empty()) return;
    const auto is_it = [&](const Pose& pose) {
      return T_world_camera &&
             is_among(*T_world_camera, std::span(&pose, 1), config.taken_tolerance);
    };
    const auto found = std::find_if(state.planned.begin(), state.planned.end(), is_it);
    state.planned.erase(found == state.planned.end() ? state.planned.begin() : found);
  }

  // The remaining views of the plan that are still good.
  Proposal planned_proposal() {
    Proposal left = proposer.propose_these({std::string(kPlanned), state.planned}, scorer.grid(),
                                           scorer.scene(), state.reached, state.missed);
    keep_worth(*scorer.evaluator(), config.ahead, state.seen_area, left);
    state.planned = poses_of(left.candidates);
    return left;
  }

  Ranking plan(const GainEvaluator& by, std::span<const Pose> poses, const RankConfig& rank_config,
               const BatchControl& control) {
    return is_of_plan ? rank_in_turn(by, poses, rank_config, control)
                      : plan_views(by, poses, config.ahead, state.seen_area, rank_config, control);
  }

  // A view from elsewhere does not test the prediction.
  void forget_promise_unless_kept_at(const std::optional<Pose>& T_world_camera) {
    const bool is_there =
        state.promised && T_world_camera &&
        is_among(*T_world_camera, std::span(&*state.promised, 1), config.taken_tolerance);
    state.promised.reset();
    if (is_there) return;
    state.after_choice.promised_area = state.after_choice.promised_gain =
        std::numeric_limits<double>::quiet_NaN();
  }

  void require_a_usable_frame() const {
    if (state.frames.empty() || is_in_map(state.frames.begin()->first)) return;
    std::string counts;
    for (const auto& [reason, count] : bad_frames(state.frames)) {
      counts += (counts.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
    }
    refuse("no view can be proposed, because no frame could be used so far (" + counts +
           "). Are the poses camera to world? Are the units and the workspace right?");
  }

  // After a decision, which replaces an earlier one of the same view.
  void remember(std::optional<DecisionMaking::Decision> chosen, const Proposal& from) {
    decision = chosen;
    StopRules rules(planning, state.before_choice);
    state.of_choice = rules.after_decision(decision, from, state.seen_area);
    state.after_choice = rules.memory();
  }

  Ranking rank(std::span<const Pose> poses, std::size_t k, RankConfig rank_config,
               const BatchControl& control, const Proposal* from) {
    require_a_usable_frame();
    const Stopwatch watch;
    if (!rank_config.current_pose) rank_config.current_pose = state.last_pose;
    const std::shared_ptr<const GainEvaluator> evaluator = scorer.evaluator();
    const GainEvaluator& by = *evaluator;
    const bool plans = from != nullptr && config.ahead.is_on();
    // The first view determines the stop reason, for any k.
    Ranking ranking =
        plans ? plan(by, poses, rank_config, control)
              : rank_views(by, poses, std::max<std::size_t>(k, 1), rank_config, control);
    if (from != nullptr && ranking.complete) {
      state.promised.reset();
      if (!ranking.views.empty()) state.promised = ranking.views.front().T_world_camera;
      remember(decision_of(ranking, by.model()), *from);
    }
    if (from != nullptr) leave_out_gainless(ranking, rank_config);
    if (plans && !is_of_plan && ranking.complete) {
      state.planned.clear();
      for (const RankedView& view : ranking.views) {
        if (state.planned.size() < config.ahead.take) state.planned.push_back(view.T_world_camera);
      }
    }
    ranking.views.resize(std::min(ranking.views.size(), k));
    seconds["score"] += watch.seconds();
    return ranking;
  }
};

ViewPlanner::ViewPlanner(ViewScorer scorer, const PlannerConfig& config)
    : impl_(std::make_unique<Impl>(std::move(scorer), config)) {
  impl_->begin();
}
ViewPlanner::ViewPlanner(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ViewPlanner::~ViewPlanner() = default;
ViewPlanner::ViewPlanner(ViewPlanner&&) noexcept = default;
ViewPlanner& ViewPlanner::operator=(ViewPlanner&&) noexcept = default;

void ViewPlanner::add_poses(PoseSet set) {
  for (std::size_t i = 0; i < set.poses.size(); ++i) {
    check_rigid(set.poses[i],
                ("pose " + std::to_string(i) + " of the set \"" + set.generator + "\"").c_str());
  }
  impl_->proposer.add_poses(std::move(set));
  impl_->proposal.reset();
}

void ViewPlanner::add_generation(std::shared_ptr<ViewpointGeneration> generation) {
  if (!generation) refuse("the generation is null");
  impl_->proposer.add_generation(std::move(generation));
  impl_->proposal.reset();
}

FrameRegistration ViewPlanner::register_frame(const DepthFrame& frame, const Pose& T_reported,
                                              const PoseSigma& sigma) const {
  Impl& m = *impl_;
  std::call_once(m.is_registering, [&] {
    m.registration.emplace(m.scorer.sensor(), m.scorer.config(), m.scorer.exec());
  });
  return m.registration->register_frame(m.scorer.grid(), frame, T_reported, sigma);
}

AddedView ViewPlanner::add(const DepthFrame& frame, const Pose& T_world_camera,
                           const PoseSigma& pose_sigma) {
  return add(std::span(&frame, 1), T_world_camera, pose_sigma);
}

AddedView ViewPlanner::add(std::span<const DepthFrame> frames, const Pose& T_world_camera,
                           const PoseSigma& pose_sigma) {
  Impl& m = *impl_;
  if (frames.empty()) refuse("a view must have at least one frame");
  return m.counted(m.scorer.add({T_world_camera, {frames.begin(), frames.end()}, pose_sigma}),
                   T_world_camera);
}

AddedView ViewPlanner::drop(FrameVerdict verdict, const std::optional<Pose>& T_world_camera) {
  if (is_in_map(verdict)) refuse("a dropped frame cannot have the verdict \"used\" or \"carved\"");
  MapUpdate nothing;
  nothing.verdict = verdict;
  return impl_->counted(std::move(nothing), T_world_camera);
}

const FrameCounts& ViewPlanner::frames() const noexcept { return impl_->state.frames; }

const Proposal& ViewPlanner::propose() {
  Impl& m = *impl_;
  m.require_a_usable_frame();
  const Stopwatch watch;
  Proposal proposal;
  if (!m.state.planned.empty()) proposal = m.planned_proposal();
  m.is_of_plan = !proposal.candidates.empty();
  if (!m.is_of_plan) {
    proposal =
        m.proposer.propose(m.scorer.grid(), m.scorer.scene(), m.state.last_pose.value_or(Pose()),
                           m.state.reached, m.state.missed);
  }
  m.state.of_choice.reset();
  m.state.after_choice = m.state.before_choice;
  m.state.promised.reset();
  if (proposal.candidates.empty()) m.state.of_choice = nowhere_to_go(proposal);
  m.seconds["candidates"] += watch.seconds();
  return m.proposal.emplace(std::move(proposal));
}

const std::vector<DroppedCandidate>& ViewPlanner::dropped() const noexcept {
  static const std::vector<DroppedCandidate> none;
  return impl_->proposal ? impl_->proposer.dropped() : none;
}

std::size_t ViewPlanner::candidate_count() const noexcept {
  return impl_->proposal ? impl_->proposal->candidates.size() : 0;
}

Ranking ViewPlanner::rank(std::size_t k, const RankConfig& config, const BatchControl& control) {
  if (!impl_->proposal) {
    refuse("rank: there are no candidates. After each view, call propose() before rank()");
  }
  return impl_->rank(poses_of(impl_->proposal->candidates), k, config, control, &*impl_->proposal);
}

Ranking ViewPlanner::rank(std::span<const Pose> T_world_camera, std::size_t k,
                          const RankConfig& config, const BatchControl& control) {
  return impl_->rank(T_world_camera, k, config, control, nullptr);
}

void ViewPlanner::tried(const Pose& T_world_camera, bool reached) {
  check_rigid(T_world_camera, "the pose that was tried");
  (reached ? impl_->state.reached : impl_->state.missed).push_back(T_world_camera);
  if (reached) impl_->state.last_pose = T_world_camera;
  if (!impl_->proposal) return;
  impl_->proposer.drop(T_world_camera, reached ? infeasibility_name(Infeasibility::taken) : kMissed,
                       *impl_->proposal);
}

std::optional<StopReason> ViewPlanner::should_stop() const noexcept {
  const detail::PlannerState& state = impl_->state;
  return state.of_view ? state.of_view : state.of_choice;
}

void ViewPlanner::save(const std::filesystem::path& path) const {
  const BeliefGrid& grid = impl_->scorer.grid();
  MapNotes notes = grid.notes();
  notes.others[kNote] = detail::text_of(impl_->state);
  save_vdb(grid, path, {.notes = std::move(notes)});
}

ViewPlanner ViewPlanner::load(const std::filesystem::path& path, const Sensor& sensor,
                              const ScorerConfig& scorer, const PlannerConfig& config,
                              const ExecConfig& exec) {
  BeliefGrid grid = load_vdb(path, exec);
  MapNotes notes = grid.notes();
  const auto note = notes.others.extract(kNote);  // save() rewrites it
  grid.set_notes(std::move(notes));
  if (note.empty()) {
    throw Error(ErrorCode::format,
                path.string() + ": the map has no planner state, because no planner saved it");
  }
  const BeliefGrid expected(scorer.grid(), sensor);
  if (grid.voxel_size() != expected.voxel_size() || grid.dims() != expected.dims() ||
      grid.min_index() != expected.min_index() || grid.prior_sigma() != expected.prior_sigma() ||
      !(grid.T_world_grid() == expected.T_world_grid())) {
    refuse(path.string() + ": the saved map (" + layout_text(grid) +
           ") differs from the configuration (" + layout_text(expected));
  }
  detail::PlannerState state = detail::state_of(path.string() + " (note planner)", note.mapped());
  std::size_t added = state.first_views;
  for (const auto& [verdict, count] : state.frames) added += is_in_map(verdict) ? count : 0;
  if (added != grid.views().size()) {
    refuse(path.string() + ": the map has " + std::to_string(grid.views().size()) +
           " views, but the planner that saved it added only " + std::to_string(added) +
           "; create a new planner for this map");
  }
  auto impl = std::make_unique<Impl>(ViewScorer(std::move(grid), sensor, scorer, exec), config);
  impl->state = std::move(state);
  // A state of version 2 does not contain it.
  const std::vector<Pose>& views = impl->scorer.grid().views();
  if (!impl->state.last_pose && !views.empty()) impl->state.last_pose = views.back();
  // The limits come from the current configuration; the result of the last decision remains.
  impl->state.of_view = limit_reached(impl->planning, impl->state.after_choice);
  return ViewPlanner(std::move(impl));
}

const ViewScorer& ViewPlanner::scorer() const noexcept { return impl_->scorer; }
const StageSeconds& ViewPlanner::seconds() const noexcept { return impl_->seconds; }
const PlanningConfig& ViewPlanner::planning() const noexcept { return impl_->planning; }
const std::optional<DecisionMaking::Decision>& ViewPlanner::decision() const noexcept {
  return impl_->decision;
}

}  // namespace viewgain
