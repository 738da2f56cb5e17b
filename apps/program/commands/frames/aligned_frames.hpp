// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <stop_token>

#include "program/commands/frames/frame_map.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain::app {

/// Aligns all frames of the folder with one another (FrameAlignment), for a map into which none has
/// gone yet. `sigma`: by how much each reported pose may be off. By the frame's index, those that
/// cannot be read left out, each as known in the end; after a stop those so far. Throws as
/// FrameAlignment.
[[nodiscard]] std::map<std::size_t, FrameRegistration> align_folder(const FrameMap& map,
                                                                    const PoseSigma& sigma,
                                                                    bool quiet,
                                                                    const ExecConfig& exec,
                                                                    const std::stop_token& stop);

}  // namespace viewgain::app
