// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::test {

/// Two triangles: a square of half-width `half` [m] in the plane z = height [m], normal -z.
[[nodiscard]] TriangleMesh square(double half, double height);

/// A latitude-longitude sphere round the origin with `rings` rings and twice as many sectors, its
/// vertices on the sphere, normals outward. Radius [m].
[[nodiscard]] TriangleMesh sphere(double radius, int rings);

}  // namespace viewgain::test
