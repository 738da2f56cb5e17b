// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/core/reach.hpp"

namespace viewgain::app {

/// Where a robot can put the camera; apps/README.md shows the layout, each part of which may be
/// missing. Throws Error(io) if a file cannot be read and Error(format), naming the file and the
/// key, for a key that is missing, unknown, of the wrong type or out of bounds.
[[nodiscard]] ReachRegion read_reach_toml(const std::filesystem::path& path);

}  // namespace viewgain::app
