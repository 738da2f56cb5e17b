// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/view_planner.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "choose/planner_settings.hpp"
#include "choose/planner_state.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/stop_rules.hpp"
#include "viewgain/planner/map_registration.hpp"
#include "viewgain/support/stopwatch.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr const char* kNote = "planner";  // the note of the saved map that holds the state

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorCode::invalid_argument, what); }

void check_rigid(const Pose& pose, const char* what) {
  if (!(orthonormality_error(pose) <= 1e-3)) {
    fail(std::string(what) + " is not a rigid transform of finite numbers");
  }
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

// What the stopping rules want to know of a ranking.
Decision decision_of(const Ranking& ranking, std::span<const ViewGain> looked_at, GainModel model) {
  Decision decision;
  const ViewGain& best = ranking.views.front().gain;
  decision.candidate = ranking.views.front().index;
  decision.gain = best.gain;
  decision.area = best.area;
  if (std::isnan(best.gain)) return decision;  // bad poses, or a measure of the user's own
  if (model == GainModel::paper) {
    const std::uint32_t touched = best.unknown_voxels + best.occupied_voxels;
    decision.gain_per_voxel = touched > 0 ? best.gain / touched : 0.0;
  } else {
    decision.best_area = 0;
    for (const ViewGain& gain : looked_at) {
      decision.best_area = std::fmax(decision.best_area, gain.area);
    }
  }
  return decision;
}

// As StopRules::after_view() would have it of the last view; there is no coverage here.
std::optional<StopReason> limit_reached(const PlanningConfig& limits, const StopMemory& memory) {
  if (memory.views == 0) return std::nullopt;
  if (memory.views >= limits.max_views) return StopReason::max_views;
  if (limits.idle_views > 0 && memory.idle_views >= limits.idle_views) return StopReason::idle;
  return std::nullopt;
}

}  // namespace

struct ViewPlanner::Impl {
  PlannerConfig config;
  ExecConfig exec;
  PlanningConfig planning;
  MapModel map;
  detail::PlannerState state;
  FeasibilityChecker checker;
  std::optional<GainEvaluator> evaluator;
  std::vector<PoseSet> sets;
  std::vector<std::shared_ptr<ViewpointGeneration>> generations;
  std::optional<Proposal> proposal;
  std::vector<DroppedCandidate> dropped;
  StageSeconds seconds;
  std::optional<MapRegistration> registration;  // once it is asked for

  Impl(const PlannerConfig& config_in, const ExecConfig& exec_in, MapModel map_in)
      : config(config_in),
        exec(exec_in),
        planning(detail::planning_config(config_in)),
        map(std::move(map_in)),
        checker(map.scene(), detail::feasibility_config(config, map.sensor()), exec) {
    (void)StopRules(planning);  // refuses what no run can have
    if (!config.reach.poses.empty()) sets.push_back({"reach", config.reach.poses});
  }

  [[nodiscard]] Pose last_pose() const {
    return map.grid().views().empty() ? Pose() : map.grid().views().back();
  }

  GainEvaluator& current_evaluator() {
    if (!evaluator) {
      evaluator.emplace(map.scene(), map.sensor(), detail::gain_config(config), exec);
    } else if (&evaluator->scene() != map.scene().get()) {
      evaluator = evaluator->with_scene(map.scene());
    }
    return *evaluator;
  }

  [[nodiscard]] std::vector<Candidate> all_candidates(Proposal& of_generations) {
    std::vector<Candidate> all;
    for (const PoseSet& set : sets) {
      for (std::size_t i = 0; i < set.poses.size(); ++i) {
        all.push_back({set.poses[i], set.generator, std::nullopt, i});
      }
    }
    for (const auto& generation : generations) {
      Proposal made = generation->generate(last_pose());
      std::move(made.candidates.begin(), made.candidates.end(), std::back_inserter(all));
      for (const auto& [reason, count] : made.dropped) of_generations.dropped[reason] += count;
    }
    return all;
  }

  // Why each candidate is not possible; empty: it is.
  [[nodiscard]] std::vector<std::string> reasons_against(
      const std::vector<Candidate>& candidates) const {
    const std::vector<Pose> poses = poses_of(candidates);
    std::vector<Pose> taken = map.grid().views();
    taken.insert(taken.end(), state.reached.begin(), state.reached.end());
    std::vector<std::string> reasons(poses.size());
    std::vector<Infeasibility> found(poses.size(), Infeasibility::none);
    if (config.check_feasibility) found = checker.check(poses, taken);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!config.check_feasibility && is_among(poses[i], taken, config.taken_tolerance)) {
        found[i] = Infeasibility::taken;
      }
      if (found[i] != Infeasibility::none) {
        reasons[i] = infeasibility_name(found[i]);
      } else if (is_among(poses[i], state.missed, config.taken_tolerance)) {
        reasons[i] = kMissed;
      }
    }
    return reasons;
  }

  void forget_proposal() {
    proposal.reset();
    dropped.clear();
  }

  // Takes what is the same as a pose that was tried out of the proposal.
  void drop_from_proposal(const Pose& tried, const std::string& reason) {
    if (!proposal) return;
    const auto is_tried = [&](const Candidate& candidate) {
      return is_among(candidate.T_world_camera, std::span(&tried, 1), config.taken_tolerance);
    };
    std::vector<Candidate>& candidates = proposal->candidates;
    const auto gone =
        std::stable_partition(candidates.begin(), candidates.end(), std::not_fn(is_tried));
    for (auto it = gone; it != candidates.end(); ++it) {
      ++proposal->dropped[reason];
      dropped.push_back({std::move(*it), reason});
    }
    candidates.erase(gone, candidates.end());
  }

  // After a choice, which takes the place of an earlier one of the same view.
  void remember(const std::optional<Decision>& decision, const Proposal& from) {
    StopRules rules(planning, state.before_choice);
    state.of_choice = rules.after_decision(decision, from, state.seen_area);
    state.after_choice = rules.memory();
  }

  [[nodiscard]] std::vector<double> costs(std::span<const Pose> poses,
                                          const RankConfig& rank) const {
    if (!std::isfinite(rank.cost_per_metre) || rank.cost_per_metre < 0) {
      fail("cost_per_metre " + short_text(rank.cost_per_metre) + " must be at least 0 and finite");
    }
    std::vector<double> costs(rank.costs.begin(), rank.costs.end());
    if (rank.cost_per_metre == 0 || map.grid().views().empty()) return costs;
    if (costs.empty()) costs.resize(poses.size());
    if (costs.size() != poses.size()) return costs;  // best() refuses them
    const Eigen::Vector3d here = last_pose().translation();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double way = (poses[i].translation() - here).norm();
      // A bad pose is last whatever the way to it.
      if (std::isfinite(way)) costs[i] += rank.cost_per_metre * way;
    }
    return costs;
  }

  Ranking rank(std::span<const Pose> poses, std::size_t k, const RankConfig& rank_config,
               const BatchControl& control, const Proposal* from) {
    const Stopwatch watch;
    const std::vector<double> all_costs = costs(poses, rank_config);
    const GainEvaluator& by = current_evaluator();
    RacedViews best;
    if (rank_config.exact || by.model() == GainModel::paper) {
      const BestConfig best_config{all_costs, rank_config.measure, rank_config.run_measure};
      // All of them, since the rule of area asks for the most that any promises.
      static_cast<BestViews&>(best) = by.best(poses, poses.size(), control, best_config);
      best.scored_gains = best.gains;
    } else {
      RaceConfig race;
      race.costs = all_costs;
      race.measure = rank_config.measure;
      race.run_measure = rank_config.run_measure;
      best = by.race(poses, std::max<std::size_t>(k, 1), race, control);
    }
    Ranking ranking;
    ranking.complete = best.complete;
    ViewGain none;
    // The first one says why to end, whatever k.
    const std::size_t wanted = std::min(best.indices.size(), std::max<std::size_t>(k, 1));
    for (std::size_t i = 0; i < wanted; ++i) {
      const std::size_t at = best.indices[i];
      ranking.views.push_back(
          {at, poses[at], best.gains.empty() ? none : best.gains[i], best.worth[i]});
    }
    if (ranking.complete && from != nullptr) {
      std::optional<Decision> decision;
      if (!ranking.views.empty()) {
        decision = decision_of(ranking, best.scored_gains, by.model());
      }
      remember(decision, *from);
    }
    ranking.views.resize(std::min(ranking.views.size(), k));
    seconds["score"] += watch.seconds();
    return ranking;
  }
};

ViewPlanner::ViewPlanner(const Sensor& sensor, const PlannerConfig& config, const ExecConfig& exec)
    : impl_(std::make_unique<Impl>(config, exec,
                                   MapModel(sensor, detail::map_config(config, sensor), exec))) {
  // The configuration of the gain is refused here, not at the first ranking.
  (void)impl_->current_evaluator();
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
  impl_->sets.push_back(std::move(set));
  impl_->forget_proposal();
}

void ViewPlanner::add_generation(std::shared_ptr<ViewpointGeneration> generation) {
  if (!generation) fail("the generation is null");
  impl_->generations.push_back(std::move(generation));
  impl_->forget_proposal();
}

FrameRegistration ViewPlanner::register_frame(const DepthFrame& frame,
                                              const PosePrior& prior) const {
  Impl& m = *impl_;
  if (!m.registration) {
    m.registration.emplace(m.map.sensor(), detail::map_config(m.config, m.map.sensor()), m.exec);
  }
  return m.registration->register_frame(m.map.grid(), frame, prior);
}

AddedView ViewPlanner::add(const DepthFrame& frame, const Pose& T_world_camera,
                           const PoseSigma& pose_sigma) {
  return add(std::span(&frame, 1), T_world_camera, pose_sigma);
}

AddedView ViewPlanner::add(std::span<const DepthFrame> frames, const Pose& T_world_camera,
                           const PoseSigma& pose_sigma) {
  Impl& m = *impl_;
  if (frames.empty()) fail("a view without a frame");
  AddedView added;
  added.view = m.state.after_choice.views;
  const double before = m.state.after_choice.entropy_removed;
  added.update = m.map.update({T_world_camera, {frames.begin(), frames.end()}, pose_sigma});
  added.progress = m.map.progress();
  // Without follow_surface nobody asks for the area.
  if (!std::isnan(added.update.new_area)) m.state.seen_area += added.update.new_area;
  added.progress.surface_area = m.state.seen_area;
  added.entropy_removed = added.progress.entropy_removed - before;
  m.seconds = added.update.seconds;
  m.forget_proposal();
  m.checker = m.checker.with_scene(m.map.scene());
  StopRules rules(m.planning, m.state.after_choice);
  m.state.of_view = rules.after_view(added.progress);
  m.state.of_choice.reset();
  m.state.before_choice = m.state.after_choice = rules.memory();
  return added;
}

const Proposal& ViewPlanner::propose() {
  Impl& m = *impl_;
  const Stopwatch watch;
  Proposal proposal;
  std::vector<Candidate> all = m.all_candidates(proposal);
  const std::vector<std::string> reasons = m.reasons_against(all);
  m.dropped.clear();
  sort_candidates(std::move(all), reasons, proposal, m.dropped);
  m.state.of_choice.reset();
  m.state.after_choice = m.state.before_choice;
  if (proposal.candidates.empty()) m.state.of_choice = nowhere_to_go(proposal);
  m.seconds["candidates"] += watch.seconds();
  return m.proposal.emplace(std::move(proposal));
}

const std::vector<DroppedCandidate>& ViewPlanner::dropped() const noexcept {
  return impl_->dropped;
}

std::size_t ViewPlanner::candidate_count() const noexcept {
  return impl_->proposal ? impl_->proposal->candidates.size() : 0;
}

Ranking ViewPlanner::rank(std::size_t k, const RankConfig& config, const BatchControl& control) {
  if (!impl_->proposal) {
    fail("rank: there are no candidates; propose() comes first, after each view anew");
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
  impl_->drop_from_proposal(
      T_world_camera, std::string(reached ? infeasibility_name(Infeasibility::taken) : kMissed));
}

std::optional<StopReason> ViewPlanner::should_stop() const noexcept {
  const detail::PlannerState& state = impl_->state;
  return state.of_view ? state.of_view : state.of_choice;
}

void ViewPlanner::save(const std::filesystem::path& path, VdbWriteConfig config) const {
  if (path.extension() == ".ot" || path.extension() == ".bt") {
    fail(path.string() + ": the state is an OpenVDB file, and this name is OctoMap's");
  }
  config.notes[kNote] = detail::text_of(impl_->state);
  save_vdb(impl_->map.grid(), path, config);
}

ViewPlanner ViewPlanner::load(const std::filesystem::path& path, const Sensor& sensor,
                              const PlannerConfig& config, const ExecConfig& exec) {
  const MapModelConfig map = detail::map_config(config, sensor);
  VdbMap saved = load_vdb_map(path);
  const auto note = saved.notes.find(kNote);
  if (note == saved.notes.end()) {
    throw Error(ErrorCode::format, path.string() + ": is a map without the state of a planner");
  }
  const BeliefGrid expected(map.grid);
  const BeliefGrid& grid = saved.grid;
  if (grid.voxel_size() != expected.voxel_size() || grid.dims() != expected.dims() ||
      grid.min_index() != expected.min_index() || grid.prior_sigma() != expected.prior_sigma() ||
      !(grid.T_world_grid() == expected.T_world_grid())) {
    fail(path.string() + ": its map, " + layout_text(grid) +
         ", is laid out otherwise than the configuration says, " + layout_text(expected));
  }
  detail::PlannerState state = detail::state_of(path.string() + " (note planner)", note->second);
  auto impl =
      std::make_unique<Impl>(config, exec, MapModel(std::move(saved.grid), sensor, map, exec));
  impl->state = std::move(state);
  // The limits are those of today's configuration; what the last choice said stays.
  impl->state.of_view = limit_reached(impl->planning, impl->state.after_choice);
  (void)impl->current_evaluator();
  return ViewPlanner(std::move(impl));
}

const MapModel& ViewPlanner::map() const noexcept { return impl_->map; }
const BeliefGrid& ViewPlanner::grid() const noexcept { return impl_->map.grid(); }
const GainEvaluator& ViewPlanner::evaluator() { return impl_->current_evaluator(); }
const StageSeconds& ViewPlanner::seconds() const noexcept { return impl_->seconds; }

}  // namespace viewgain
