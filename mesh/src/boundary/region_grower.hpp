// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/mesh/surface.hpp"

namespace viewgain::detail {

/// grow_region() for many seeds: builds the adjacency once. The surface must be valid
/// (check_surface) and outlive this object. Not thread safe, because members share scratch memory.
class RegionGrower {
 public:
  explicit RegionGrower(const SurfaceMesh& surface);

  /// See grow_region() in patch.hpp. The seeds must be vertices of the surface.
  [[nodiscard]] std::vector<std::uint32_t> grow(std::span<const std::uint32_t> seeds, double depth,
                                                double max_turn);

 private:
  const SurfaceMesh& surface_;
  std::vector<std::uint32_t> first_;      // per vertex, index into neighbors_; one more at the end
  std::vector<std::uint32_t> neighbors_;  // contains an edge with two faces twice
  std::vector<double> distance_;          // infinity between calls
};

}  // namespace viewgain::detail
