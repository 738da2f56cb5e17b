// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/view_proposer.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "viewgain/planner/hazard_views.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kFromReach = 1200;  // views
constexpr double kPlaces = 0.03;          // distance between the points that they look at [m]

// Includes faces, because a camera may be on a limit.
bool is_in_workspace(const BeliefGrid& grid, const Pose& pose) {
  const Box box = grid.workspace();
  const Eigen::Vector3d p = grid.T_world_grid().inverse() * pose.translation();
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = p[static_cast<Eigen::Index>(a)];
    if (!(x >= box.min[a] && x <= box.max[a])) return false;
  }
  return true;
}

void add(const PoseSet& set, std::vector<Candidate>& candidates) {
  for (std::size_t i = 0; i < set.poses.size(); ++i) {
    candidates.push_back({set.poses[i], set.generator, std::nullopt, i});
  }
}

}  // namespace

std::vector<Pose> poses_of(std::span<const Candidate> candidates) {
  std::vector<Pose> poses;
  poses.reserve(candidates.size());
  for (const Candidate& candidate : candidates) poses.push_back(candidate.T_world_camera);
  return poses;
}

ViewProposer::ViewProposer(std::shared_ptr<const VoxelScene> scene, ProposerConfig config,
                           const ExecConfig& exec)
    : config_(std::move(config)), checker_(std::move(scene), config_.feasibility, exec) {
  const std::vector<Pose>& reach = config_.feasibility.reach.poses;
  if (!reach.empty()) sets_.push_back({"reach", reach});
}

void ViewProposer::add_poses(PoseSet set) { sets_.push_back(std::move(set)); }

void ViewProposer::add_generation(std::shared_ptr<ViewpointGeneration> generation) {
  generations_.push_back(std::move(generation));
}

bool ViewProposer::draws_from_reach() const {
  const ReachRegion& reach = config_.feasibility.reach;
  return !generations_.empty() && config_.distance_in_reach > 0 && !reach.is_everywhere() &&
         reach.poses.empty();
}

bool ViewProposer::stays_inside(const BeliefGrid& grid) const {
  const std::vector<Pose>& views = grid.views();
  return config_.check_feasibility && config_.feasibility.reach.is_everywhere() && !views.empty() &&
         std::all_of(views.begin(), views.end(),
                     [&grid](const Pose& view) { return is_in_workspace(grid, view); });
}

Proposal ViewProposer::propose_these(const PoseSet& set, const BeliefGrid& grid,
                                     std::shared_ptr<const VoxelScene> scene,
                                     std::span<const Pose> reached, std::span<const Pose> missed) {
  checker_ = checker_.with_scene(std::move(scene));
  Proposal proposal;
  std::vector<Candidate> candidates;
  add(set, candidates);
  keep_possible(std::move(candidates), set.poses.size(), grid, reached, missed, proposal);
  return proposal;
}

Proposal ViewProposer::propose(const BeliefGrid& grid, std::shared_ptr<const VoxelScene> scene,
                               const Pose& T_world_camera, std::span<const Pose> reached,
                               std::span<const Pose> missed) {
  checker_ = checker_.with_scene(std::move(scene));
  Proposal proposal;
  std::vector<Candidate> candidates;
  for (const PoseSet& set : sets_) add(set, candidates);
  const std::size_t of_sets = candidates.size();
  for (const auto& generation : generations_) {
    Proposal made = generation->generate(T_world_camera);
    std::move(made.candidates.begin(), made.candidates.end(), std::back_inserter(candidates));
    for (const auto& [reason, count] : made.dropped) proposal.dropped[reason] += count;
  }
  if (draws_from_reach()) {
    add({std::string(kReachViews),
         reachable_hazard_views(checker_.scene(), config_.feasibility.reach,
                                config_.distance_in_reach, kPlaces, kFromReach)},
        candidates);
  }
  keep_possible(std::move(candidates), of_sets, grid, reached, missed, proposal);
  return proposal;
}

void ViewProposer::keep_possible(std::vector<Candidate> candidates, std::size_t of_sets,
                                 const BeliefGrid& grid, std::span<const Pose> reached,
                                 std::span<const Pose> missed, Proposal& proposal) {
  std::vector<Infeasibility> found(candidates.size(), Infeasibility::none);
  if (stays_inside(grid)) {
    for (std::size_t i = of_sets; i < candidates.size(); ++i) {
      if (!is_in_workspace(grid, candidates[i].T_world_camera)) {
        found[i] = Infeasibility::unreachable;
      }
    }
  }
  std::vector<Pose> taken = grid.views();
  taken.insert(taken.end(), reached.begin(), reached.end());
  const ReachRegion::Tolerance& tolerance = config_.feasibility.taken_tolerance;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (found[i] == Infeasibility::none) poses.push_back(candidates[i].T_world_camera);
  }
  std::vector<Infeasibility> checked;
  if (config_.check_feasibility) {
    checked = checker_.check(poses, taken);
  } else {
    for (const Pose& pose : poses) {
      checked.push_back(is_among(pose, taken, tolerance) ? Infeasibility::taken
                                                         : Infeasibility::none);
    }
  }
  dropped_.clear();
  std::size_t next = 0;  // of the checked poses
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (found[i] == Infeasibility::none) found[i] = checked[next++];
    std::string_view reason;
    if (found[i] != Infeasibility::none) {
      reason = infeasibility_name(found[i]);
    } else if (is_among(candidates[i].T_world_camera, missed, tolerance)) {
      reason = kMissed;
    }
    if (reason.empty()) {
      proposal.candidates.push_back(std::move(candidates[i]));
    } else {
      ++proposal.dropped[std::string(reason)];
      dropped_.push_back({std::move(candidates[i]), std::string(reason)});
    }
  }
}

void ViewProposer::drop(const Pose& tried, std::string_view reason, Proposal& proposal) {
  const auto is_tried = [&](const Candidate& candidate) {
    return is_among(candidate.T_world_camera, std::span(&tried, 1),
                    config_.feasibility.taken_tolerance);
  };
  std::vector<Candidate>& candidates = proposal.candidates;
  const auto gone =
      std::stable_partition(candidates.begin(), candidates.end(), std::not_fn(is_tried));
  for (auto it = gone; it != candidates.end(); ++it) {
    ++proposal.dropped[std::string(reason)];
    dropped_.push_back({std::move(*it), std::string(reason)});
  }
  candidates.erase(gone, candidates.end());
}

}  // namespace viewgain
