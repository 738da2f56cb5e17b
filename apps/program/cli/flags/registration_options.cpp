// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/registration_options.hpp"

#include <algorithm>

#include "program/cli/choices.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"

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

std::optional<PosePrior> registration_prior(const RegistrationOptions& options,
                                            const PoseNoise& noise) {
  if (options.is_on != "on") {
    if (options.pose_sigma.empty()) return std::nullopt;
    throw Error(ErrorCode::invalid_argument,
                "--pose-sigma " + options.pose_sigma + " goes with --register on");
  }
  PosePrior prior;
  if (!options.pose_sigma.empty()) {
    const PoseNoise stated = parse_pose_noise("--pose-sigma", options.pose_sigma, 0);
    check_positive("--pose-sigma", std::min(stated.sigma_translation, stated.sigma_rotation));
    prior.sigma_translation = stated.sigma_translation;
    prior.sigma_rotation = stated.sigma_rotation;
    return prior;
  }
  if (noise.sigma_translation > 0) prior.sigma_translation = noise.sigma_translation;
  if (noise.sigma_rotation > 0) prior.sigma_rotation = noise.sigma_rotation;
  return prior;
}

}  // namespace viewgain::app
