// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace viewgain::detail {

// OctoMap's files: a text header up to the line "data", then the nodes depth first. A child's
// number has bit 0 for x, bit 1 for y, bit 2 for z. A node of a .ot file is its log-odds (a float,
// the maximum of its children's, if any), then a byte of children.
inline constexpr std::string_view kOctomapFullMark = "# Octomap OcTree file";
inline constexpr std::string_view kOctomapBinaryMark = "# Octomap OcTree binary file";

/// A tree has 16 levels under its root: 65,536 voxels per axis, half of them below the origin.
inline constexpr int kOctomapLevels = 16;
inline constexpr std::int32_t kOctomapOffset = 32768;

}  // namespace viewgain::detail
