// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "planning_options.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

[[noreturn]] void fail(std::string_view flag, std::string_view text, const std::string& what) {
  throw Error(ErrorCode::invalid_argument,
              std::string(flag).append(" ").append(text).append(": ").append(what));
}

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

}  // namespace

const std::vector<std::string>& generator_names() {
  static const std::vector<std::string> names{"boundary", "sphere", "dome",
                                              "rings",    "shell",  "sequence"};
  return names;
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
    set.poses = shell_poses(count, 0.8 * request.distance, 1.25 * request.distance, request.seed,
                            request.center);
  } else if (generator == "sequence") {
    set.poses = sequence_poses(request);
  } else {
    fail("--generator", generator, "no such set of poses");
  }
  return set;
}

double filling_distance(const Sensor& sensor, double radius) {
  const PinholeCamera& camera = sensor.camera;
  // A camera of one line has no second side.
  const double half_x = std::atan(0.5 * camera.width / camera.fx);
  const double half_y = camera.height > 1 ? std::atan(0.5 * camera.height / camera.fy) : half_x;
  return std::max(sensor.working_distance, radius / std::sin(std::min(half_x, half_y)));
}

EstimatorConfig default_estimator(double voxel_size) {
  EstimatorConfig config;
  config.boundary.min_run_length = 8 * voxel_size;
  config.boundary.min_loop_length = 8 * voxel_size;
  config.overlap = 0.4;
  config.distances = {1.0, 1.15};
  config.tilts = {0.0, 15 * kDegree, -15 * kDegree};
  config.rolls = {0.0, 90 * kDegree};
  return config;
}

Pose parse_pose(std::string_view flag, std::string_view text) {
  const std::vector<double> n = parse_numbers(flag, text, 7, 7);
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (!(std::abs(q.norm() - 1) < 1e-2)) {
    fail(flag, text, "the quaternion qx,qy,qz,qw has the norm " + short_text(q.norm()));
  }
  return {q.normalized().toRotationMatrix(), Eigen::Vector3d(n[0], n[1], n[2])};
}

std::vector<std::string> parse_names(std::string_view flag, std::string_view text,
                                     const std::vector<std::string>& valid) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name(text.substr(begin, end - begin));
    if (std::find(valid.begin(), valid.end(), name) == valid.end()) {
      std::string list;
      for (const std::string& v : valid) list.append(" ").append(v);
      fail(flag, text, "\"" + name + "\" is none of" + list);
    }
    names.push_back(name);
    begin = end + 1;
  }
  return names;
}

}  // namespace viewgain::app
