// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>

#include "viewgain/mesh/surface.hpp"

namespace viewgain::test {

/// Uniform in [0, 1) for (seed, index); the same on every machine.
[[nodiscard]] double hashed_uniform(std::uint64_t seed, std::uint64_t index);
/// Standard normal for (seed, index).
[[nodiscard]] double hashed_normal(std::uint64_t seed, std::uint64_t index);

using Edge = std::pair<std::uint32_t, std::uint32_t>;  ///< in the face's direction

/// The edges without their reverse, by a search of its own.
[[nodiscard]] std::set<Edge> border_by_counting(const SurfaceMesh& surface);

[[nodiscard]] Eigen::Vector3d vertex_position(const SurfaceMesh& surface, std::uint32_t vertex);

/// Sets vertex normals to the area-weighted mean of their faces' normals.
void set_normals_from_faces(SurfaceMesh& surface);

/// (columns + 1) × (rows + 1) vertices at place(i, j); faces turn from +i to +j, two a cell.
[[nodiscard]] SurfaceMesh sheet(
    std::uint32_t columns, std::uint32_t rows,
    const std::function<Eigen::Vector3d(std::uint32_t, std::uint32_t)>& place);

/// The rectangle |x| <= width / 2, |y| <= height / 2 of the plane z = 0, outward +z [m].
[[nodiscard]] SurfaceMesh plane_sheet(double width, double height, double spacing);

/// A cylinder about the z axis, |z| <= height / 2, azimuth from -half_angle to half_angle about -y,
/// outward; vertices moved along the normal by Gaussian noise [m].
[[nodiscard]] SurfaceMesh cylinder_sheet(double radius, double height, double half_angle,
                                         double spacing, double noise = 0, std::uint64_t seed = 1);

/// A closed sphere round the origin: `rings` rings and twice as many sectors, one vertex a pole.
[[nodiscard]] SurfaceMesh closed_sphere(double radius, std::uint32_t rings);

/// Without the faces for which `drop(index)` holds; vertices stay.
[[nodiscard]] SurfaceMesh without_faces(SurfaceMesh surface,
                                        const std::function<bool(std::size_t)>& drop);

/// Both, the second moved by `offset`.
[[nodiscard]] SurfaceMesh joined(const SurfaceMesh& a, const SurfaceMesh& b,
                                 const Eigen::Vector3d& offset);

}  // namespace viewgain::test
