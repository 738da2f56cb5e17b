// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "viewgain/core/export.hpp"
#include "viewgain/core/reach.hpp"

/// @file
/// Files of reachable regions. Each call reads or writes each file once. Cost: O(parts).

namespace viewgain {

/// Reads a region. apps/docs/reference/formats.md documents the layout; all parts are optional.
/// Throws Error(io) if a file cannot be read and Error(format) with file and key for a key that is
/// missing, unknown, of the wrong type or out of bounds.
[[nodiscard]] VIEWGAIN_EXPORT ReachRegion read_reach_toml(const std::filesystem::path& path);

/// Writes a region. When read back, angles and rotations differ only by rounding (1e-14). Poses go
/// to a TUM file next to the region's file: NAME.poses.txt for NAME.toml. An existing file is
/// replaced. Each file is written atomically. Throws Error(io). Throws Error(invalid_argument) for
/// a region that is invalid or has a predicate, for a name that does not end in .toml and, if there
/// are poses, for a name that is not UTF-8.
VIEWGAIN_EXPORT void write_reach_toml(const std::filesystem::path& path, const ReachRegion& region);

/// The pose file that a reach file refers to, if any. Throws like read_reach_toml() for a file that
/// is not TOML.
[[nodiscard]] VIEWGAIN_EXPORT std::optional<std::filesystem::path> reach_poses_file(
    const std::filesystem::path& path);

}  // namespace viewgain
