// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/planner_parts.hpp"

#include "viewgain/core/error.hpp"

namespace viewgain {

ModelProgress PlannerParts::update(const Measurements& measurements) {
  return planner_.add(measurements.frames, measurements.T_world_camera, measurements.pose_sigma)
      .progress;
}

Proposal PlannerParts::generate(const Pose&) { return planner_.propose(); }

std::optional<DecisionMaking::Decision> PlannerParts::decide(
    const Pose& T_world_camera, std::span<const Candidate> candidates) {
  if (candidates.size() != planner_.candidate_count()) {
    refuse("the candidates differ from the last proposal of the planner");
  }
  RankConfig config = config_;
  config.current_pose = T_world_camera;
  (void)planner_.rank(1, config);
  return planner_.decision();
}

}  // namespace viewgain
