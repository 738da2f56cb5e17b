// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/pose_source.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Generator and numbers of a value such as "sphere:2000,0.6".
struct SetOfPoses {
  std::string_view kind, numbers;
};

constexpr std::array<std::string_view, 5> kKinds{"sphere", "dome", "rings", "shell", "orbit"};

// Empty for the name of a file.
std::optional<SetOfPoses> set_in(std::string_view value) {
  const std::size_t colon = value.find(':');
  const std::string_view kind = value.substr(0, colon);
  if (colon == std::string_view::npos || std::ranges::find(kKinds, kind) == kKinds.end()) {
    return std::nullopt;
  }
  return SetOfPoses{kind, value.substr(colon + 1)};
}

std::vector<Pose> orbit(const std::vector<double>& n, const Eigen::Vector3d& center) {
  const double start = n.size() > 3 ? n[3] * kDegree : 0.0;
  const std::optional<double> step =
      n.size() > 4 ? std::optional<double>(n[4] * kDegree) : std::nullopt;
  return orbit_poses(parse_count("--poses", n[0]), n[1], n[2] * kDegree, start, step, center);
}

std::vector<Pose> poses_of(const SetOfPoses& set, const Eigen::Vector3d& center,
                           std::uint64_t seed) {
  const bool is_orbit = set.kind == "orbit", is_shell = set.kind == "shell";
  const std::size_t least = is_orbit || is_shell ? 3 : 2;
  const std::string flag = "--poses " + std::string(set.kind) + ":";
  const auto n = parse_numbers(flag, set.numbers, least, is_orbit ? 5 : least);
  if (is_orbit) return orbit(n, center);
  const std::size_t count = parse_count("--poses", n[0]);
  if (is_shell) return shell_poses(count, n[1], n[2], seed, center);
  if (set.kind == "rings") return literature_ring_poses(count, n[1], center);
  return set.kind == "dome" ? dome_poses(count, n[1], center) : sphere_poses(count, n[1], center);
}

}  // namespace

bool is_set_of_poses(const std::string& value) { return set_in(value).has_value(); }

void add_pose_options(App& app, PoseOptions& options) {
  app.add_option("--poses", options.poses,
                 "TUM or .npy file of camera-to-world poses, or a set of poses such as "
                 "sphere:500,0.6 (see below)")
      ->required();
  explain_values(app,
                 "Values of --poses: a file, or a set of N poses that look at --center\n"
                 "[m, degrees]:\n"
                 "  FILE (TUM)          lines with time tx ty tz qx qy qz qw [s, m]\n"
                 "  FILE.npy            structured array with fields tx, ty, tz, qx, qy, qz, qw,\n"
                 "                      or (n, 4, 4) matrices; float64 or float32\n"
                 "  sphere:N,RADIUS     evenly spread over a sphere\n"
                 "  dome:N,RADIUS       evenly spread over the upper half of a sphere\n"
                 "  rings:N,RADIUS      on horizontal rings of a cylinder and of a dome above it;\n"
                 "                      N is 48, 80, 288 or 864\n"
                 "  shell:N,RMIN,RMAX   random places between two radii; depends on --seed\n"
                 "  orbit:N,RADIUS,ELEVATION[,START,STEP]  on a circle at this elevation\n");
  app.add_option("--center", options.center,
                 "x,y,z: point that sets of poses look at, world frame [m] (default: the origin)");
}

void add_cost_options(App& app, CostOptions& options, const std::string& of) {
  app.add_option("--costs", options.file,
                 "file with one cost per pose in " + of +
                     ", in the gain's unit; each cost is subtracted from the gain of its pose");
  app.add_option("--cost-per-metre", options.per_metre, kCostPerMetreHelp);
  app.add_option("--from", options.from,
                 "x,y,z: current position of the camera, world frame [m] (default: position of the "
                 "last frame or, for a map file, of its last view)");
}

void check(const CostOptions& options, bool has_way) {
  check_at_least_0("--cost-per-metre", options.per_metre);
  if (options.from.empty()) return;
  if (options.per_metre == 0 && !has_way) {
    refuse("--from", options.from, "the flag requires --cost-per-metre or --plan");
  }
  (void)parse_point("--from", options.from);
}

std::vector<double> read_costs(const std::string& file, std::size_t poses) {
  const std::string bytes = file_bytes(file);
  LineReader reader(file, bytes);
  std::vector<double> costs;
  while (reader.next()) {
    if (reader.words().empty() || reader.words()[0].front() == '#') continue;
    if (reader.words().size() > 1) reader.fail("expected one cost per line");
    costs.push_back(reader.finite_number(0));
    if (costs.back() < 0) reader.fail("a cost must be at least 0");
  }
  if (costs.size() == poses) return costs;
  refuse(file + ": the file must have one cost per pose; poses: " + std::to_string(poses) +
         ", costs: " + std::to_string(costs.size()));
}

PoseSource make_poses(const PoseOptions& options, std::uint64_t seed) {
  if (const auto set = set_in(options.poses)) {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    if (!options.center.empty()) center = parse_point("--center", options.center);
    try {
      return {poses_of(*set, center, seed)};
    } catch (const Error& error) {  // generators do not name flags
      if (std::string_view(error.what()).starts_with("--poses")) throw;
      throw Error(error.code(), "--poses " + options.poses + ": " + error.what());
    }
  }
  if (!options.center.empty()) {
    refuse("--center", options.center, "cannot be used with a file of poses");
  }
  std::error_code ignored;
  const std::size_t colon = options.poses.find(':');
  if (colon != std::string::npos && !std::filesystem::exists(options.poses, ignored)) {
    const std::vector<std::string> kinds(kKinds.begin(), kKinds.end());
    refuse("--poses " + options.poses + ": no such file, and " +
           fault_of_name(options.poses.substr(0, colon), kinds, "set of poses"));
  }
  PoseList list = load_poses(options.poses);
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
        "--cost-per-metre: the map has no views, so the current position of the camera is unknown; "
        "give --from x,y,z");
  }
  return std::nullopt;
}

std::vector<Pose> poses_in(const std::string& file) {
  if (const auto set = set_in(file)) {
    refuse("--poses " + file + ": expected a file of poses; for a set of poses, use --generator " +
           std::string(set->kind) + " with --count and --distance");
  }
  PoseOptions options;
  options.poses = file;
  return make_poses(options, 0).poses;
}

}  // namespace viewgain::app
