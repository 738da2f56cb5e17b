// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/registration_options.hpp"

#include <algorithm>

#include "program/cli/choices.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain::app {

void add_registration_options(App& app, RegistrationOptions& options) {
  on_or_off(*app.add_option("--register", options.is_on,
                            "register each frame against the map before it goes in; one that "
                            "contradicts the map is left out")
                 ->capture_default_str());
  app.add_option("--pose-sigma", options.pose_sigma,
                 "SIGMA_M,SIGMA_DEG by which reported poses may be off, of --register; default: "
                 "0.005,0.5");
}

std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                            const PoseSigma& noise) {
  if (options.is_on != "on") {
    if (options.pose_sigma.empty()) return std::nullopt;
    throw Error(ErrorCode::invalid_argument,
                "--pose-sigma " + options.pose_sigma + " goes with --register on");
  }
  if (!options.pose_sigma.empty()) {
    const PoseSigma stated = parse_pose_sigma("--pose-sigma", options.pose_sigma);
    check_positive("--pose-sigma", std::min(stated.translation, stated.rotation));
    return stated;
  }
  PoseSigma sigma = kUsualPoseSigma;
  if (noise.translation > 0) sigma.translation = noise.translation;
  if (noise.rotation > 0) sigma.rotation = noise.rotation;
  return sigma;
}

}  // namespace viewgain::app
