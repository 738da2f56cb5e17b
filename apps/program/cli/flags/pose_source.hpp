// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "viewgain/core/pose.hpp"
#include "viewgain/support/columns/part_head.hpp"

namespace viewgain::app {

/// Which of the poses: all, one of n shards of nearly equal length, or rows [begin, end).
class RowSelection {
 public:
  /// Of --shard i/n and --rows a:b, of which one may be given; empty: not given. Throws
  /// Error(invalid_argument), naming the flag.
  static RowSelection parse(const std::string& shard, const std::string& rows);

  [[nodiscard]] bool is_all() const { return text_.empty(); }
  /// Of so many poses. Throws Error(invalid_argument) if there are not as many.
  [[nodiscard]] RowRange of(std::uint64_t poses) const;

 private:
  std::string text_;  // the flag and its value
  bool is_shard_ = false;
  std::uint64_t first_ = 0, second_ = 0;
};

/// Poses that the command line asked for.
struct PoseSource {
  std::vector<Pose> poses;          ///< T_world_camera, of the rows asked for
  std::size_t orthonormalized = 0;  ///< of a file: how many rotations were mended
  RowRange rows;                    ///< of these among all
  std::uint64_t total = 0;          ///< poses in all
  /// Of their number and of the numbers of at most 4,096 of all poses, evenly spread: tells sets of
  /// poses apart without reading the whole of a large file.
  std::string hash;

  /// The pose of a row among all.
  [[nodiscard]] const Pose& at(std::size_t row) const { return poses.at(row - rows.begin); }
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

/// `seed`: of the shell. Of a .npy only the rows asked for are read; sets and TUM files are made
/// whole, and rows taken from them. Throws Error(invalid_argument), naming the flag, or what
/// read_tum and MappedPoses throw.
[[nodiscard]] PoseSource make_poses(const PoseOptions& options, std::uint64_t seed,
                                    const RowSelection& selection = {});

}  // namespace viewgain::app
