// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A surface, or points where there are no triangles, as arrays of the caller's, in whatever frame:
/// the file does not say.
struct VIEWGAIN_EXPORT PlyArrays {
  std::span<const std::array<double, 3>> positions;  ///< [m], in any order
  std::span<const std::array<double, 3>> normals{};  ///< unit vectors; empty, or one a position
  std::span<const float> sigma{};                    ///< [m]; empty, or one a position
  std::span<const std::array<std::uint32_t, 3>> triangles{};  ///< three indices each, in any order
};

/// Writes positions (double), normals (nx ny nz), standard deviations (sigma, [m]) and faces as
/// binary PLY, in the machine's byte order. Atomic: a temporary file is renamed. Throws
/// Error(invalid_argument), naming the file, if the sizes differ or a triangle has no such vertex,
/// and Error(io). Costs O(positions + triangles).
VIEWGAIN_EXPORT void write_ply(const std::filesystem::path& path, const PlyArrays& arrays);

}  // namespace viewgain
