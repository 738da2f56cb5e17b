// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "program/cli/json.hpp"

namespace viewgain::app {

/// Triangles as the page draws them. World [m].
struct ShownMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<double> sigma, error;  ///< one a vertex [m], or none

  void add_vertex(const std::array<double, 3>& p) { vertices.emplace_back(p[0], p[1], p[2]); }
};

/// The mesh with at most `most` vertices: those in a cell of a lattice become one, their mean, and
/// triangles without area go. As it is if it is small enough. For looking at, not for measuring.
[[nodiscard]] ShownMesh thinned(ShownMesh mesh, std::size_t most);

/// A mesh of README.md, "Data".
[[nodiscard]] Json to_json(const ShownMesh& mesh);

}  // namespace viewgain::app
