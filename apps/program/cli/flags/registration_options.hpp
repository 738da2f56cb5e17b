// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "program/cli/app.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::app {

/// Whether frames are registered, as the command line says it.
struct RegistrationOptions {
  std::string is_on = "off";  ///< --register on|off
  std::string pose_sigma;     ///< --pose-sigma SIGMA_M,SIGMA_DEG; empty: the default
};

/// --register and --pose-sigma, for frames that go into a map one after the other.
void add_registration_options(App& app, RegistrationOptions& options);

/// By how much reported poses may be off: what --pose-sigma says, else `noise` (--pose-noise) where
/// it is not 0; nothing without --register on. Throws Error(invalid_argument), naming the flag,
/// also for --pose-sigma without --register on.
[[nodiscard]] std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                                          const PoseSigma& noise = {});

}  // namespace viewgain::app
