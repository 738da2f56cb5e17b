// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "pose_source.hpp"

#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <utility>

#include "values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

[[noreturn]] void refuse(const std::string& flag, const std::string& text,
                         const std::string& what) {
  throw Error(ErrorCode::invalid_argument, flag + " " + text + ": " + what);
}

// Generators know nothing of flags; a user does not know which value is meant without one.
template <typename Make>
std::vector<Pose> naming_the_flag(const std::string& flag, const std::string& text, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), flag + " " + text + ": " + error.what());
  }
}

using CenteredGenerator = std::vector<Pose> (*)(std::size_t, double, const Eigen::Vector3d&);

std::vector<Pose> round_center(const std::string& flag, const std::string& text,
                               const Eigen::Vector3d& center, CenteredGenerator generator) {
  const std::vector<double> n = parse_numbers(flag, text, 1, 16);
  if (n.size() != 2) refuse(flag, text, "needs N,RADIUS; the centre is given by --center x,y,z");
  const std::size_t count = parse_count(flag, n[0]);
  return naming_the_flag(flag, text, [&] { return generator(count, n[1], center); });
}

std::vector<Pose> orbit(const std::string& text, const Eigen::Vector3d& center) {
  const std::vector<double> n = parse_numbers("--orbit", text, 3, 5);
  const std::size_t count = parse_count("--orbit", n[0]);
  const double start = n.size() > 3 ? n[3] * kDegree : 0.0;
  const std::optional<double> step =
      n.size() > 4 ? std::optional<double>(n[4] * kDegree) : std::nullopt;
  return naming_the_flag("--orbit", text, [&] {
    return orbit_poses(count, n[1], n[2] * kDegree, start, step, center);
  });
}

std::vector<Pose> shell(const std::string& text, const Eigen::Vector3d& center,
                        std::uint64_t seed) {
  const std::vector<double> n = parse_numbers("--shell", text, 3, 7);
  if (n.size() != 3) {
    refuse("--shell", text,
           "needs N,RMIN,RMAX; the seed is given by --seed, the centre by --center x,y,z");
  }
  const std::size_t count = parse_count("--shell", n[0]);
  return naming_the_flag("--shell", text,
                         [&] { return shell_poses(count, n[1], n[2], seed, center); });
}

}  // namespace

PoseSource make_poses(const PoseOptions& options, std::uint64_t seed) {
  PoseSource source;
  if (!options.file.empty()) {
    if (!options.center.empty()) {
      refuse("--center", options.center, "goes with sets of poses, not with --poses");
    }
    PoseList list = read_tum(options.file);
    source.poses = std::move(list.poses);
    source.orthonormalized = list.orthonormalized;
    return source;
  }
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  if (!options.center.empty()) center = parse_point("--center", options.center);
  if (!options.orbit.empty()) {
    source.poses = orbit(options.orbit, center);
  } else if (!options.sphere.empty()) {
    source.poses = round_center("--sphere", options.sphere, center, sphere_poses);
  } else if (!options.rings.empty()) {
    source.poses = round_center("--rings", options.rings, center, literature_ring_poses);
  } else if (!options.shell.empty()) {
    source.poses = shell(options.shell, center, seed);
  } else {
    source.poses = round_center("--dome", options.dome, center, dome_poses);
  }
  return source;
}

}  // namespace viewgain::app
