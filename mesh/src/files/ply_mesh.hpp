// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::detail {

/// The mesh of a PLY file's bytes: vertices with x, y, z and faces with a list vertex_indices or
/// vertex_index, whatever else it holds. Throws Error(format) that begins with `name`.
[[nodiscard]] TriangleMesh ply_mesh(std::string_view bytes, const std::string& name);

}  // namespace viewgain::detail
