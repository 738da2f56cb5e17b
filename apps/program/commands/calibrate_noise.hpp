// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/formats/frames.hpp"

namespace viewgain::app {

/// `calibrate --noise`: writes the sensor of `frames`, all from one pose, with the noise that they
/// show, and prints what was found. Throws Error for frames that do not tell it.
void calibrate_noise(const FrameSequence& frames, const std::string& out, bool json, bool quiet);

}  // namespace viewgain::app
