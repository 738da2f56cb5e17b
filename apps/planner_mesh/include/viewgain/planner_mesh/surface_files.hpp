// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "viewgain/core/export.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain {

/// Writes the model's surface and its points as PLY, each vertex with its normal and its standard
/// deviation along it (`sigma` [m]). Atomic, each file for itself. Throws Error(io).
VIEWGAIN_EXPORT void write_surfaces(const SurfaceModel& model,
                                    const std::filesystem::path& surface_file,
                                    const std::filesystem::path& points_file);

}  // namespace viewgain
