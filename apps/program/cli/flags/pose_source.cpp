// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/pose_source.hpp"

#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <utility>

#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/formats/pose_files.hpp"
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

void add_pose_options(App& app, PoseOptions& options) {
  auto* poses = app.add_option_group("poses", "exactly one of");
  poses->add_option(
      "--poses", options.file,
      "TUM file of camera-to-world poses: time tx ty tz qx qy qz qw [s, m]; or .npy: rows with "
      "tx, ty, tz, qx, qy, qz, qw, or (n, 4, 4) matrices, float64 or float32");
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
  poses->require_option(1, 1);
  app.add_option("--center", options.center,
                 "x,y,z that the sets of poses look at, world [m]; default: the origin");
}

void add_cost_options(App& app, CostOptions& options, const std::string& of) {
  app.add_option("--costs", options.file,
                 "file of one number for each of " + of +
                     ", which is subtracted from its gain, in the gain's unit");
  app.add_option("--cost-per-metre", options.per_metre, kCostPerMetreHelp);
  app.add_option(
      "--from", options.from,
      "x,y,z of the camera in the world [m], where path lengths begin (default: at the last frame, "
      "used or not; for a map file at its last view)");
}

void check(const CostOptions& options, bool has_way) {
  check_at_least_0("--cost-per-metre", options.per_metre);
  if (options.from.empty()) return;
  if (options.per_metre == 0 && !has_way) {
    refuse("--from", options.from,
           "goes with ways that cost (--cost-per-metre) or are planned (next --plan)");
  }
  (void)parse_point("--from", options.from);
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

PoseSource make_poses(const PoseOptions& options, std::uint64_t seed) {
  if (options.file.empty()) return {set_of_poses(options, seed)};
  if (!options.center.empty()) {
    refuse("--center", options.center, "goes with sets of poses, not with --poses");
  }
  PoseList list = load_poses(options.file);
  return {std::move(list.poses), list.orthonormalized};
}

std::optional<Pose> last_view(const BeliefGrid& grid) {
  if (grid.views().empty()) return std::nullopt;
  return grid.views().back();
}

std::optional<Pose> begin_of_ways(const CostOptions& options,
                                  const std::optional<Pose>& last_pose) {
  if (!options.from.empty()) {
    return Pose(Eigen::Matrix3d::Identity(), parse_point("--from", options.from));
  }
  if (last_pose) return last_pose;
  if (options.per_metre > 0) {
    refuse(
        "--cost-per-metre: the map has no view, which would say where the camera is; --from x,y,z "
        "does");
  }
  return std::nullopt;
}

std::vector<Pose> poses_in(const std::string& file) {
  PoseOptions options;
  options.file = file;
  return make_poses(options, 0).poses;
}

}  // namespace viewgain::app
