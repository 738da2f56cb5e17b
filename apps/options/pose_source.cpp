// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "pose_source.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"

namespace viewgain::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

using CenteredGenerator = std::vector<Pose> (*)(std::size_t, double, const Eigen::Vector3d&);

// Generators know nothing of flags; a user does not know which value is meant without one.
template <typename Make>
std::vector<Pose> naming_the_flag(const std::string& flag, const std::string& text, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(error.code(), flag + " " + text + ": " + error.what());
  }
}

std::vector<Pose> round_center(const std::string& flag, const std::string& text,
                               CenteredGenerator generator) {
  const std::vector<double> n = parse_numbers(flag, text, 2, 5);
  if (n.size() != 2 && n.size() != 5) {
    throw Error(ErrorCode::invalid_argument,
                flag + " " + text + ": needs N,RADIUS or N,RADIUS,CX,CY,CZ");
  }
  const Eigen::Vector3d center =
      n.size() == 5 ? Eigen::Vector3d(n[2], n[3], n[4]) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  const std::size_t count = parse_count(flag, n[0]);
  return naming_the_flag(flag, text, [&] { return generator(count, n[1], center); });
}

std::vector<Pose> orbit(const std::string& text) {
  const std::vector<double> n = parse_numbers("--orbit", text, 3, 5);
  const std::size_t count = parse_count("--orbit", n[0]);
  const double start = n.size() > 3 ? n[3] * kDegree : 0.0;
  const std::optional<double> step =
      n.size() > 4 ? std::optional<double>(n[4] * kDegree) : std::nullopt;
  return naming_the_flag("--orbit", text,
                         [&] { return orbit_poses(count, n[1], n[2] * kDegree, start, step); });
}

std::vector<Pose> shell(const std::string& text) {
  constexpr const char* kFlag = "--shell";
  constexpr double kMaxSeed = 0x1.0p53;  // whole numbers up to here are exact
  const std::vector<double> n = parse_numbers(kFlag, text, 4, 7);
  if (n.size() != 4 && n.size() != 7) {
    throw Error(ErrorCode::invalid_argument,
                "--shell " + text + ": needs N,RMIN,RMAX,SEED or N,RMIN,RMAX,SEED,CX,CY,CZ");
  }
  const std::size_t count = parse_count(kFlag, n[0]);
  if (!(n[3] >= 0 && n[3] <= kMaxSeed && n[3] == std::floor(n[3]))) {
    throw Error(ErrorCode::invalid_argument,
                "--shell " + text + ": the seed must be a whole number from 0 to 2^53");
  }
  const Eigen::Vector3d center =
      n.size() == 7 ? Eigen::Vector3d(n[4], n[5], n[6]) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  return naming_the_flag(kFlag, text, [&] {
    return shell_poses(count, n[1], n[2], static_cast<std::uint64_t>(n[3]), center);
  });
}

}  // namespace

PoseSource make_poses(const PoseOptions& options) {
  PoseSource source;
  if (!options.file.empty()) {
    PoseList list = read_tum(options.file);
    source.poses = std::move(list.poses);
    source.orthonormalized = list.orthonormalized;
  } else if (!options.orbit.empty()) {
    source.poses = orbit(options.orbit);
  } else if (!options.sphere.empty()) {
    source.poses = round_center("--sphere", options.sphere, sphere_poses);
  } else if (!options.rings.empty()) {
    source.poses = round_center("--rings", options.rings, literature_ring_poses);
  } else if (!options.shell.empty()) {
    source.poses = shell(options.shell);
  } else {
    source.poses = round_center("--dome", options.dome, dome_poses);
  }
  return source;
}

}  // namespace viewgain::app
