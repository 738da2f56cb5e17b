// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <span>

#include "viewgain/core/export.hpp"
#include "viewgain/mesh/surface.hpp"

namespace viewgain {

/// Writes vertices (double), normals (nx ny nz), a per-vertex standard deviation (sigma, [m]) and
/// faces as binary PLY. sigma may be empty, else one a vertex. Atomic: a temporary file is renamed.
/// Throws Error(invalid_argument) if the sizes differ or a triangle has no such vertex, Error(io).
VIEWGAIN_EXPORT void write_surface_ply(const std::filesystem::path& path,
                                       const SurfaceMesh& surface, std::span<const float> sigma);

/// The same for points without faces; normals may be empty too.
VIEWGAIN_EXPORT void write_points_ply(const std::filesystem::path& path,
                                      std::span<const std::array<double, 3>> points,
                                      std::span<const std::array<double, 3>> normals,
                                      std::span<const float> sigma);

}  // namespace viewgain
