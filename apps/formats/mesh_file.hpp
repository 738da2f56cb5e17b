// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "viewgain/mesh/mesh_io.hpp"

namespace viewgain::app {

/// Reads a mesh and places it. Throws what read_mesh throws, and what placed throws with the file's
/// name before it.
[[nodiscard]] TriangleMesh load_mesh(const std::filesystem::path& path,
                                     const MeshPlacement& placement);

}  // namespace viewgain::app
