// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "viewgain/core/box.hpp"

namespace viewgain::test {

using Polygon = std::vector<Eigen::Vector3d>;

/// A box with any orientation, for oracles that cut polygons instead of looking for separating
/// axes.
struct Solid {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;  ///< columns
  Eigen::Vector3d half;

  [[nodiscard]] static Solid of(const Box& box);
  [[nodiscard]] bool contains(const Eigen::Vector3d& p) const;
};

/// Whether something of a convex polygon is left inside the solid.
[[nodiscard]] bool reaches_into(Polygon polygon, const Solid& solid);

/// Whether two solids share more than their surfaces.
[[nodiscard]] bool overlap(const Solid& a, const Solid& b);

}  // namespace viewgain::test
