// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/pose_source.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <charconv>
#include <numbers>
#include <optional>
#include <utility>

#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/columns/mapped_poses.hpp"
#include "viewgain/support/columns/parts.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

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
  const std::vector<double> n = parse_numbers(flag, text, 2, 2);
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
  const std::vector<double> n = parse_numbers("--shell", text, 3, 3);
  const std::size_t count = parse_count("--shell", n[0]);
  return naming_the_flag("--shell", text,
                         [&] { return shell_poses(count, n[1], n[2], seed, center); });
}

PoseSource mapped_poses(const std::string& file, const Shard& shard) {
  const MappedPoses mapped(file);
  PoseSource source;
  source.total = mapped.size();
  source.rows = shard.of(mapped.size());
  source.hash = mapped.hash();
  source.poses.reserve(source.rows.end - source.rows.begin);
  for (std::size_t row = source.rows.begin; row < source.rows.end; ++row) {
    bool mended = false;
    source.poses.push_back(mapped.at(row, mended));
    source.orthonormalized += mended ? 1 : 0;
  }
  return source;
}

std::vector<Pose> set_of_poses(const PoseOptions& options, std::uint64_t seed) {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  if (!options.center.empty()) center = parse_point("--center", options.center);
  if (!options.orbit.empty()) return orbit(options.orbit, center);
  if (!options.sphere.empty())
    return round_center("--sphere", options.sphere, center, sphere_poses);
  if (!options.rings.empty()) {
    return round_center("--rings", options.rings, center, literature_ring_poses);
  }
  if (!options.shell.empty()) return shell(options.shell, center, seed);
  return round_center("--dome", options.dome, center, dome_poses);
}

}  // namespace

void add_pose_options(App& app, PoseOptions& options, bool needed) {
  auto* poses = app.add_option_group("poses", needed ? "exactly one of" : "at most one of");
  poses->add_option(
      "--poses", options.file,
      "TUM file of camera-to-world poses: time tx ty tz qx qy qz qw [s, m]; or .npy: rows with "
      "tx, ty, tz, qx, qy, qz, qw, or (n, 4, 4) matrices");
  poses->add_option("--sphere", options.sphere,
                    "N,RADIUS: Fibonacci lattice on a sphere round --center, looking at it [m]");
  poses->add_option("--dome", options.dome,
                    "N,RADIUS: the lattice's upper half, with N points [m]");
  poses->add_option("--rings", options.rings,
                    "N,RADIUS: cylinder and dome rings of the literature, N is 48, 80, 288 or 864 "
                    "[m]");
  poses->add_option("--shell", options.shell,
                    "N,RMIN,RMAX: at random (--seed) between two spheres [m]");
  poses->add_option("--orbit", options.orbit,
                    "N,RADIUS,ELEVATION_DEG[,START_DEG,STEP_DEG]: N views on a circle of latitude "
                    "[m, degrees]; START 0, STEP 360/N");
  poses->require_option(needed ? 1 : 0, 1);
  app.add_option("--center", options.center,
                 "x,y,z that the sets of poses look at, world [m]; default: the origin");
}

void add_cost_options(App& app, CostOptions& options, const std::string& of) {
  app.add_option("--costs", options.file,
                 "file of one number for each of " + of +
                     ", which is subtracted from its gain, in the gain's unit");
  app.add_option("--cost-per-metre", options.per_metre, kCostPerMetreHelp)->capture_default_str();
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool is_slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = std::from_chars(is_slash ? index.ptr + 1 : end, end, shard.count);
  if (count.ec != std::errc() || count.ptr != end) refuse("--shard", text, "must be i/n, i from 0");
  constexpr std::uint64_t kMost = 10'000'000;
  if (shard.index >= shard.count || shard.count > kMost) {
    refuse("--shard", text, "i must be below n, from 0, and n at most 10,000,000");
  }
  return shard;
}

std::vector<double> read_costs(const std::string& file, std::size_t poses) {
  const std::string bytes = file_bytes(file);
  LineReader reader(file, bytes);
  std::vector<double> costs;
  while (reader.next()) {
    if (reader.words().empty() || reader.words()[0].front() == '#') continue;
    if (reader.words().size() > 1) reader.fail("a line has one cost");
    costs.push_back(reader.finite_number(0));
    if (costs.back() < 0) reader.fail("a cost must not be negative");
  }
  if (costs.size() == poses) return costs;
  refuse(file + ": has " + std::to_string(costs.size()) + " costs for " + std::to_string(poses) +
         " poses");
}

PoseSource make_poses(const PoseOptions& options, std::uint64_t seed, const Shard& shard) {
  if (!options.file.empty() && !options.center.empty()) {
    refuse("--center", options.center, "goes with sets of poses, not with --poses");
  }
  if (is_npy(options.file)) return mapped_poses(options.file, shard);
  PoseSource source;
  source.poses = options.file.empty() ? set_of_poses(options, seed) : std::vector<Pose>();
  if (!options.file.empty()) {
    PoseList list = read_tum(options.file);
    source.poses = std::move(list.poses);
    source.orthonormalized = list.orthonormalized;
  }
  source.total = source.poses.size();
  source.rows = shard.of(source.total);
  source.hash = hash_of_poses(source.total, Pose().m.size(), [&](std::size_t row, std::size_t i) {
    return source.poses[row].m[i];
  });
  if (shard.count > 1) {
    const auto begin = source.poses.begin();
    source.poses = std::vector<Pose>(begin + static_cast<std::ptrdiff_t>(source.rows.begin),
                                     begin + static_cast<std::ptrdiff_t>(source.rows.end));
  }
  return source;
}

}  // namespace viewgain::app
