// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "viewgain/core/export.hpp"
#include "viewgain/core/reach.hpp"

/// @file
/// Files of where a robot can put the camera. Cost: they are read or written once, O(parts).

namespace viewgain {

/// Where a robot can put the camera; apps/docs/reference/formats.md shows the layout, each part of
/// which may be missing. Throws Error(io) if a file cannot be read and Error(format), naming the
/// file and the key, for a key that is missing, unknown, of the wrong type or out of bounds.
[[nodiscard]] VIEWGAIN_EXPORT ReachRegion read_reach_toml(const std::filesystem::path& path);

/// Writes a region so that reading it gives the same one but for the rounding of angles and
/// rotations (1e-14). Its poses, if it has any, go into a TUM file beside it, NAME.poses.txt for
/// NAME.toml, which replaces one of that name. Atomic, each file for itself. Throws Error(io), and
/// Error(invalid_argument) for a region that is not valid or has a predicate, which no file can
/// hold, and for a name that does not end in .toml or is no UTF-8 where there are poses.
VIEWGAIN_EXPORT void write_reach_toml(const std::filesystem::path& path, const ReachRegion& region);

/// The file of poses that a reach file names, if it names one. Throws as read_reach_toml does for a
/// file that is no TOML.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<std::filesystem::path> reach_poses_file(
    const std::filesystem::path& path);

}  // namespace viewgain
