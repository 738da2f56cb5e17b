// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// A triangle soup as plain arrays. Who takes one checks the indices.
struct VIEWGAIN_EXPORT TriangleMesh {
  std::vector<std::array<double, 3>> vertices;          ///< [m], or a file's own unit
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three vertex indices each
};

}  // namespace viewgain
