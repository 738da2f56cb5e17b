// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain {

/// Writes a surface and the points that it goes through as PLY, each vertex with its normal and its
/// standard deviation along it (`sigma` [m]). `points` are those that the surface was made of, in
/// their order. Atomic, each file for itself; an empty name: not written. Throws Error(io). Costs
/// O(vertices + triangles + points).
VIEWGAIN_EXPORT void write_surfaces(const SurfaceMesh& surface,
                                    const std::vector<FusedPoint>& points,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

/// The same of a model.
VIEWGAIN_EXPORT void write_surfaces(const SurfaceModel& model,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

}  // namespace viewgain
