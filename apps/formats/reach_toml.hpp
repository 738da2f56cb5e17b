// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "viewgain/core/reach.hpp"

namespace viewgain::app {

/// Where a robot can put the camera; apps/README.md shows the layout, each part of which may be
/// missing. Throws Error(io) if a file cannot be read and Error(format), naming the file and the
/// key, for a key that is missing, unknown, of the wrong type or out of bounds.
[[nodiscard]] ReachRegion read_reach_toml(const std::filesystem::path& path);

/// The file of poses that a reach file names, if it names one. Throws as read_reach_toml does for a
/// file that is no TOML.
[[nodiscard]] std::optional<std::filesystem::path> reach_poses_file(
    const std::filesystem::path& path);

}  // namespace viewgain::app
