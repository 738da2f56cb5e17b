// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/pose_sets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain {
namespace {

// The time of the ordering grows with the square of their number.
constexpr std::size_t kMostSpreadOut = 20'000;
constexpr double kDegree = std::numbers::pi / 180;

std::vector<Pose> sequence_poses(const PoseSetRequest& request) {
  const Eigen::Vector3d start = request.start
                                    ? Eigen::Vector3d(request.start->translation() - request.center)
                                    : Eigen::Vector3d(request.distance, 0, 0);
  const double radius = start.norm();
  const double elevation = std::asin(std::clamp(start.z() / radius, -1.0, 1.0));
  const double azimuth = std::atan2(start.y(), start.x());
  std::vector<Pose> poses =
      orbit_poses(8, radius, elevation, azimuth, 45 * kDegree, request.center);
  const Eigen::Vector3d above = request.center + Eigen::Vector3d(0, 0, radius);
  poses.push_back(look_at(above, request.center));
  return poses;
}

Eigen::Vector3d direction_from(const Eigen::Vector3d& center, const Pose& pose) {
  return (pose.translation() - center).normalized();
}

// Orders poses so that each is the farthest, by angle, from the start's and all before it.
std::vector<Pose> spread_out(const std::vector<Pose>& poses, const PoseSetRequest& request) {
  if (poses.size() > kMostSpreadOut) {
    refuse("at most " + std::to_string(kMostSpreadOut) + " poses can be spread out, not " +
           std::to_string(poses.size()));
  }
  std::vector<double> nearest(poses.size(), -1);  // cosine of the angle to the nearest one taken
  const auto take = [&](const Pose& pose) {
    const Eigen::Vector3d taken = direction_from(request.center, pose);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      nearest[i] = std::max(nearest[i], direction_from(request.center, poses[i]).dot(taken));
    }
  };
  if (request.start) take(*request.start);
  std::vector<Pose> ordered;
  ordered.reserve(poses.size());
  std::vector<bool> is_taken(poses.size());
  while (ordered.size() < poses.size()) {
    std::size_t next = poses.size();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (!is_taken[i] && (next == poses.size() || nearest[i] < nearest[next])) next = i;
    }
    is_taken[next] = true;
    take(ordered.emplace_back(poses[next]));
  }
  return ordered;
}

// The shells, or those around the boxes.
std::vector<ReachRegion::Shell> shells_of(const ReachRegion& reach) {
  if (!reach.shells.empty()) return reach.shells;
  std::vector<ReachRegion::Shell> shells;
  for (const Box& box : reach.boxes) {
    const Eigen::Vector3d low(box.min.data()), high(box.max.data());
    shells.push_back({0.5 * (low + high), 0, 0.5 * (high - low).norm()});
  }
  return shells;
}

// Reachable positions, in equal numbers for each shell if possible.
std::vector<Pose> poses_in_reach(const std::vector<ReachRegion::Shell>& shells, std::size_t count,
                                 const PoseSetRequest& request) {
  constexpr std::size_t kMostDrawn = 1'000'000;  // poses of one shell
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    const ReachRegion::Shell& shell = shells[i];
    const std::size_t wanted = count * (i + 1) / shells.size();
    if (!(shell.max_radius > 0)) continue;
    const double least = std::max(shell.min_radius, 1e-6 * shell.max_radius);
    // A larger count appends poses.
    std::vector<Pose> found;
    for (std::size_t drawn = count; drawn <= kMostDrawn; drawn *= 2) {
      found.clear();
      for (const Pose& pose :
           shell_poses(drawn, least, shell.max_radius, request.seed + i, shell.center)) {
        if (poses.size() + found.size() == wanted) break;
        const Pose looking = look_at(pose.translation(), request.center);
        if (request.reach.contains(looking)) found.push_back(looking);
      }
      if (poses.size() + found.size() == wanted) break;
    }
    poses.insert(poses.end(), found.begin(), found.end());
  }
  return poses;
}

}  // namespace

const std::vector<std::string>& generator_names() {
  static const std::vector<std::string> names{"boundary", "sphere", "dome",
                                              "rings",    "shell",  "sequence"};
  return names;
}

PoseSetRequest around_workspace(const BeliefGrid& grid, const Sensor& sensor) {
  const Box box = grid.workspace();
  Eigen::Vector3d center;
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    center[static_cast<Eigen::Index>(a)] = 0.5 * (box.min[a] + box.max[a]);
    longest = std::max(longest, box.max[a] - box.min[a]);
  }
  PoseSetRequest request;
  request.center = grid.T_world_grid() * center;
  request.distance = filling_distance(sensor, 0.5 * longest * 0.35 / 0.4);
  return request;
}

PoseSet make_pose_set(std::string_view generator, const PoseSetRequest& request) {
  PoseSet set{std::string(generator), {}};
  const std::size_t count = request.count.value_or(generator == "rings" ? 48 : 500);
  if (generator == "sphere") {
    set.poses = sphere_poses(count, request.distance, request.center);
  } else if (generator == "dome") {
    set.poses = dome_poses(count, request.distance, request.center);
  } else if (generator == "rings") {
    set.poses = literature_ring_poses(count, request.distance, request.center);
  } else if (generator == "shell") {
    const std::vector<ReachRegion::Shell> shells = shells_of(request.reach);
    set.poses = shells.empty() || !request.reach.poses.empty()
                    ? shell_poses(count, 0.8 * request.distance, 1.25 * request.distance,
                                  request.seed, request.center)
                    : poses_in_reach(shells, count, request);
  } else if (generator == "sequence") {
    set.poses = sequence_poses(request);
  } else {
    refuse("the set of poses \"" + std::string(generator) + "\" is unknown");
  }
  if (request.spread_out) set.poses = spread_out(set.poses, request);
  return set;
}

double filling_distance(const Sensor& sensor, double radius) {
  const PinholeCamera& camera = sensor.camera;
  // A camera with one line has no second side.
  const double half_x = std::atan(0.5 * camera.width / camera.fx);
  const double half_y = camera.height > 1 ? std::atan(0.5 * camera.height / camera.fy) : half_x;
  return std::max(sensor.working_distance, radius / std::sin(std::min(half_x, half_y)));
}

}  // namespace viewgain
