// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// The caller's arrays of a surface, or of points without triangles, in any frame. The file does
/// not state the frame.
struct VIEWGAIN_EXPORT PlyArrays {
  std::span<const std::array<double, 3>> positions;  ///< [m]
  std::span<const std::array<double, 3>> normals{};  ///< unit vectors; empty, or one per position
  std::span<const float> sigma{};                    ///< [m]; empty, or one per position
  std::span<const std::array<std::uint32_t, 3>> triangles{};  ///< three vertex indices each
};

/// Writes positions (double), normals (nx ny nz), standard deviations (sigma, [m]) and faces as
/// binary PLY in native byte order. Atomic. Throws Error(invalid_argument) naming the file if sizes
/// differ or a triangle has an invalid vertex, and Error(io). Cost: O(positions + triangles).
VIEWGAIN_EXPORT void write_ply(const std::filesystem::path& path, const PlyArrays& arrays);

}  // namespace viewgain
