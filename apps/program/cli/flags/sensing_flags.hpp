// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "program/cli/app.hpp"
#include "program/cli/described_options.hpp"
#include "program/cli/flags/sensing.hpp"

namespace viewgain::app {

/// The flags of SensingOptions, the same in every subcommand that simulates a camera. `Options` is
/// SensingOptions or const; described_options.hpp says what a visitor is.
template <typename Options, typename Visitor>
void describe_sensing(Options& o, Visitor& visit) {
  visit.option("support_plane", "--support-plane", o.support_plane,
               "height z of a table without end that occludes [m]; default: none", as_it_is);
  visit.option("noise", "--noise", o.noise,
               "Gaussian noise along the ray and across it by the sensor's model", switched);
  visit.option("flying_pixels", "--flying-pixels", o.flying_pixels,
               "mix the returns of 3x3 rays in a pixel, in sensors with a modulation frequency; "
               "default: as --noise",
               [](Option& option) { option.on_or_off(); });
  visit.option("background", "--background", o.background,
               "radius of a sphere round the origin that stands for the room [m]; 0: none",
               shows_default);
  visit.option("scale_error", "--scale-error", o.scale_error,
               "ranges read 1 + this times what they are, as by a calibration that is off",
               shows_default);
  visit.option("pose_noise", "--pose-noise", o.pose_noise,
               "SIGMA_M,SIGMA_DEG: reported poses are off by this, in each axis [m] and each "
               "component of the rotation vector [deg]; the first view's is exact and defines the "
               "world; default: none",
               as_it_is);
  visit.option(nullptr, "--seed", o.seed, "of the noise of readings and of poses",
               [](Option& option) { option.takes_seed(); });
}

inline void add_sensing_options(App& app, SensingOptions& options) {
  const OptionDeclaration declaration(app);
  describe_sensing(options, declaration);
}

}  // namespace viewgain::app
