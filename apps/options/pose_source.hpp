// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "viewgain/core/pose.hpp"

namespace viewgain::app {

/// Poses that the command line asked for.
struct PoseSource {
  std::vector<Pose> poses;          ///< T_world_camera
  std::size_t orthonormalized = 0;  ///< of a file: how many rotations were mended
};

/// The options of which one must be given, and what the sets among them look at; empty: not given.
struct PoseOptions {
  std::string file;    ///< --poses FILE, TUM
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

/// `seed`: of the shell. Throws Error(invalid_argument), naming the flag, or what read_tum throws.
[[nodiscard]] PoseSource make_poses(const PoseOptions& options, std::uint64_t seed);

}  // namespace viewgain::app
