// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "program/cli/app.hpp"
#include "program/cli/flags/pose_source.hpp"

namespace viewgain::app {

/// The flags of PoseOptions, the same in every subcommand that is given poses; one set of poses,
/// or, unless `needed`, none.
inline void add_pose_options(App& app, PoseOptions& options, bool needed = true) {
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

/// The flags of CostOptions; `of`: whose costs a file has.
inline void add_cost_options(App& app, CostOptions& options, const std::string& of) {
  app.add_option("--costs", options.file,
                 "file of one number for each of " + of +
                     ", which is subtracted from its gain, in the gain's unit");
  app.add_option("--cost-per-metre", options.per_metre,
                 "subtracted for each metre of the way from the map's last view, in the gain's "
                 "unit")
      ->capture_default_str();
}

}  // namespace viewgain::app
