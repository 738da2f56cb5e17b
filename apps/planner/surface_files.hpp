// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "model.hpp"

namespace viewgain::app {

/// Writes the model's surface and its points as PLY, each vertex with its normal and its standard
/// deviation along it (`sigma` [m]). Atomic, each file for itself. Throws Error(io).
void write_surfaces(const Model& model, const std::filesystem::path& surface_file,
                    const std::filesystem::path& points_file);

}  // namespace viewgain::app
