// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/feasibility.hpp"

/// @file
/// Poses of candidates, T_world_camera as those that are taken, and which are possible. Functions
/// keep the order of the poses, check nothing and cost O(poses), unless they say otherwise.

namespace viewgain {

/// What is asked of a sensor's poses: its body on its flange must have room, and what it sees must
/// not be nearer than it can measure. No limits of reach, no support plane.
[[nodiscard]] VIEWGAIN_EXPORT FeasibilityConfig feasibility_of(const Sensor& sensor);

/// Why a candidate is dropped that was commanded and not reached.
inline constexpr std::string_view kMissed = "missed";

/// A candidate that was not proposed.
struct VIEWGAIN_EXPORT DroppedCandidate {
  Candidate candidate;  ///< who was dropped
  std::string reason;   ///< infeasibility_name() or kMissed
};

/// Their poses, in the same order.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Pose> poses_of(std::span<const Candidate> candidates);

/// Puts candidate i, in their order, into the proposal where reasons[i] is empty, else among the
/// dropped, which the proposal counts.
VIEWGAIN_EXPORT void sort_candidates(std::vector<Candidate> candidates,
                                     std::span<const std::string> reasons, Proposal& proposal,
                                     std::vector<DroppedCandidate>& dropped);

/// The poses that are possible, and why the others are not.
struct VIEWGAIN_EXPORT FeasiblePoses {
  std::vector<Pose> poses;                     ///< that are possible, in their order
  std::vector<std::size_t> numbers;            ///< of each among those that were asked about
  std::map<std::string, std::size_t> dropped;  ///< reason -> count
};

/// Costs as FeasibilityChecker::check(), whose `taken` are in any order.
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses feasible_poses(const FeasibilityChecker& checker,
                                                           std::span<const Pose> poses,
                                                           std::span<const Pose> taken);

/// The poses in reach, in their order, whatever the body meets there. What the region's predicate
/// throws passes through.
[[nodiscard]] VIEWGAIN_EXPORT FeasiblePoses reachable_poses(const ReachRegion& reach,
                                                            std::span<const Pose> poses);

}  // namespace viewgain
