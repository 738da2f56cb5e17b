// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/columns/parts.hpp"

namespace viewgain::app {

/// One of n shards of the poses, of nearly equal length; of 1: all.
struct Shard {
  std::uint64_t index = 0, count = 1;

  [[nodiscard]] RowRange of(std::uint64_t poses) const {
    return {poses * index / count, poses * (index + 1) / count};
  }
};
/// --shard i/n; empty: all. Throws Error(invalid_argument), naming the flag.
[[nodiscard]] Shard parse_shard(const std::string& text);

/// Poses that the command line asked for.
struct PoseSource {
  std::vector<Pose> poses;          ///< T_world_camera, of the rows asked for
  std::size_t orthonormalized = 0;  ///< of a file: how many rotations were mended
  RowRange rows;                    ///< of these among all
  std::uint64_t total = 0;          ///< poses in all
  /// Of their number and the numbers of all, by which parts of different lists are told apart.
  std::string hash;

  std::vector<double> costs{};  ///< of each, in the gain's unit; empty: none

  /// The pose of a row among all.
  [[nodiscard]] const Pose& at(std::size_t row) const { return poses.at(row - rows.begin); }
  /// Its gain less its cost.
  [[nodiscard]] double worth(std::size_t row, double gain) const {
    return costs.empty() ? gain : gain - costs.at(row - rows.begin);
  }
};

/// The options of which one must be given, and what the sets among them look at; empty: not given.
struct PoseOptions {
  std::string file;    ///< --poses FILE, TUM or .npy
  std::string sphere;  ///< --sphere N,RADIUS
  std::string dome;    ///< --dome N,RADIUS
  std::string rings;   ///< --rings N,RADIUS
  std::string shell;   ///< --shell N,RMIN,RMAX
  std::string orbit;   ///< --orbit N,RADIUS,ELEVATION_DEG[,START_DEG,STEP_DEG]
  std::string center;  ///< --center x,y,z

  /// Was none of them given?
  [[nodiscard]] bool none() const {
    return file.empty() && sphere.empty() && dome.empty() && rings.empty() && shell.empty() &&
           orbit.empty();
  }
};

/// The flags of PoseOptions, the same in every subcommand that is given poses; one set of poses,
/// or, unless `needed`, none.
void add_pose_options(App& app, PoseOptions& options, bool needed = true);

/// What is subtracted from gains, in their unit.
struct CostOptions {
  std::string file;      ///< --costs: one number a pose
  double per_metre = 0;  ///< --cost-per-metre of the way from the map's last view

  [[nodiscard]] bool none() const { return file.empty() && per_metre == 0; }
};

inline constexpr const char* kCostPerMetreHelp =
    "subtracted for each metre of the way from the map's last view, in the gain's unit";
/// The flags of CostOptions; `of`: whose costs a file has.
void add_cost_options(App& app, CostOptions& options, const std::string& of);

/// Of a file with one number a line, blank lines and comments aside. Throws Error that names the
/// file, and the line or how many `poses` there are.
[[nodiscard]] std::vector<double> read_costs(const std::string& file, std::size_t poses);

/// `seed`: of the shell. A .npy is read once for the hash, and the rows asked for are kept; sets
/// and TUM files are made whole, and rows taken from them. Throws Error(invalid_argument), naming
/// the flag, or what read_tum and MappedPoses throw.
[[nodiscard]] PoseSource make_poses(const PoseOptions& options, std::uint64_t seed,
                                    const Shard& shard = {});

}  // namespace viewgain::app
