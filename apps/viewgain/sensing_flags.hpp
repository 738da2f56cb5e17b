// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "planner/sensing.hpp"

namespace viewgain::app {

/// The flags of SensingOptions, the same in every subcommand that simulates a camera.
inline void add_sensing_options(CLI::App& app, SensingOptions& options) {
  app.add_option("--background", options.background,
                 "radius of a sphere round the origin that stands for the room [m]; 0: none")
      ->capture_default_str();
  app.add_option("--support-plane", options.support_plane,
                 "height z of a table without end that occludes [m]; default: none");
  app.add_option("--noise", options.noise,
                 "Gaussian noise along the ray and across it by the sensor's model")
      ->check(CLI::IsMember({"off", "on"}))
      ->capture_default_str();
  app.add_option("--flying-pixels", options.flying_pixels,
                 "mix the returns of 3x3 rays in a pixel, in sensors with a modulation frequency; "
                 "default: as --noise")
      ->check(CLI::IsMember({"off", "on"}));
  app.add_option("--seed", options.seed, "of the noise")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 62U, "number"))
      ->capture_default_str();
  app.add_option("--wiggling", options.wiggling,
                 "amplitude A of the systematic error A sin(4 phase) [m]")
      ->capture_default_str();
  app.add_option("--calibrate", options.calibrate,
                 "measure the systematic error on a plane beforehand and subtract it")
      ->check(CLI::IsMember({"off", "on"}))
      ->capture_default_str();
}

}  // namespace viewgain::app
