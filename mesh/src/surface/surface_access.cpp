// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_access.hpp"

#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain::detail {

void check_surface(const SurfaceMesh& surface) {
  const std::size_t count = surface.vertices.size();
  if (surface.normals.size() != count) {
    throw Error(ErrorCode::invalid_argument,
                "surface: " + std::to_string(count) + " vertices but " +
                    std::to_string(surface.normals.size()) + " normals");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!vector(surface.vertices[i]).allFinite() || !vector(surface.normals[i]).allFinite()) {
      throw Error(ErrorCode::invalid_argument,
                  "surface: vertex " + std::to_string(i) + " is not finite");
    }
  }
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const std::uint32_t v : surface.triangles[i]) {
      if (v >= count) {
        throw Error(ErrorCode::invalid_argument, "surface: triangle " + std::to_string(i) +
                                                     " names vertex " + std::to_string(v) + " of " +
                                                     std::to_string(count));
      }
    }
  }
}

}  // namespace viewgain::detail
