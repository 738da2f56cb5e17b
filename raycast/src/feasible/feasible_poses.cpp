// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <span>
#include <string>
#include <vector>

#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {
namespace {

FeasiblePoses sorted(std::span<const Pose> poses, std::span<const Infeasibility> reasons) {
  FeasiblePoses result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (reasons[i] == Infeasibility::none) {
      result.poses.push_back(poses[i]);
      result.numbers.push_back(i);
    } else {
      ++result.dropped[std::string(infeasibility_name(reasons[i]))];
    }
  }
  return result;
}

}  // namespace

FeasibilityConfig feasibility_of(const Sensor& sensor) {
  FeasibilityConfig config;
  config.body.T_flange_camera = sensor.T_flange_camera;
  if (sensor.body_size) config.body.size = *sensor.body_size;
  config.sensor = sensor;
  return config;
}

FeasiblePoses feasible_poses(const FeasibilityChecker& checker, std::span<const Pose> poses,
                             std::span<const Pose> taken) {
  return sorted(poses, checker.check(poses, taken));
}

FeasiblePoses reachable_poses(const ReachRegion& reach, std::span<const Pose> poses) {
  std::vector<Infeasibility> reasons;
  reasons.reserve(poses.size());
  for (const Pose& pose : poses) {
    reasons.push_back(reach.contains(pose) ? Infeasibility::none : Infeasibility::unreachable);
  }
  return sorted(poses, reasons);
}

}  // namespace viewgain
