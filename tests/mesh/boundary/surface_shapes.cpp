// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_shapes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewgain/support/hash64.hpp"

namespace viewgain::test {
namespace {

std::uint32_t cells(double length, double spacing) {
  return static_cast<std::uint32_t>(std::max(1L, std::lround(length / spacing)));
}

}  // namespace

double hashed_uniform(std::uint64_t seed, std::uint64_t index) {
  return static_cast<double>(mix64(mix64(seed) ^ index) >> 11U) * 0x1.0p-53;
}

double hashed_normal(std::uint64_t seed, std::uint64_t index) {
  const double u = 1.0 - hashed_uniform(seed, 2 * index);
  const double v = hashed_uniform(seed, 2 * index + 1);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

std::set<Edge> border_by_counting(const SurfaceMesh& surface) {
  std::set<Edge> all;
  for (const auto& [a, b, c] : surface.triangles) {
    all.insert({a, b});
    all.insert({b, c});
    all.insert({c, a});
  }
  std::set<Edge> border;
  for (const auto& [a, b] : all) {
    if (!all.contains({b, a})) border.insert({a, b});
  }
  return border;
}

Eigen::Vector3d vertex_position(const SurfaceMesh& surface, std::uint32_t vertex) {
  return Eigen::Map<const Eigen::Vector3d>(surface.vertices.at(vertex).data());
}

void set_normals_from_faces(SurfaceMesh& surface) {
  std::vector<Eigen::Vector3d> sums(surface.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& [a, b, c] : surface.triangles) {
    const Eigen::Vector3d corner = vertex_position(surface, a);
    const Eigen::Vector3d area =
        (vertex_position(surface, b) - corner).cross(vertex_position(surface, c) - corner);
    for (const std::uint32_t v : {a, b, c}) sums[v] += area;
  }
  surface.normals.clear();
  for (const Eigen::Vector3d& sum : sums) {
    const Eigen::Vector3d n = sum.normalized();
    surface.normals.push_back({n.x(), n.y(), n.z()});
  }
}

SurfaceMesh sheet(std::uint32_t columns, std::uint32_t rows,
                  const std::function<Eigen::Vector3d(std::uint32_t, std::uint32_t)>& place) {
  SurfaceMesh surface;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const Eigen::Vector3d p = place(i, j);
      surface.vertices.push_back({p.x(), p.y(), p.z()});
      surface.source.push_back(static_cast<std::uint32_t>(surface.source.size()));
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (columns + 1) + i; };
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  set_normals_from_faces(surface);
  return surface;
}

SurfaceMesh plane_sheet(double width, double height, double spacing) {
  const std::uint32_t columns = cells(width, spacing);
  const std::uint32_t rows = cells(height, spacing);
  return sheet(columns, rows, [&](std::uint32_t i, std::uint32_t j) {
    return Eigen::Vector3d(width * (static_cast<double>(i) / columns - 0.5),
                           height * (static_cast<double>(j) / rows - 0.5), 0.0);
  });
}

SurfaceMesh cylinder_sheet(double radius, double height, double half_angle, double spacing,
                           double noise, std::uint64_t seed) {
  const std::uint32_t columns = cells(2.0 * half_angle * radius, spacing);
  const std::uint32_t rows = cells(height, spacing);
  return sheet(columns, rows, [&](std::uint32_t i, std::uint32_t j) {
    const double azimuth = half_angle * (2.0 * i / columns - 1.0);
    const double r = radius + noise * hashed_normal(seed, j * (columns + 1ULL) + i);
    return Eigen::Vector3d(r * std::sin(azimuth), -r * std::cos(azimuth),
                           height * (static_cast<double>(j) / rows - 0.5));
  });
}

SurfaceMesh closed_sphere(double radius, std::uint32_t rings) {
  SurfaceMesh surface;
  const std::uint32_t sectors = 2 * rings;
  const auto add = [&](double polar, double azimuth) {
    surface.vertices.push_back({radius * std::sin(polar) * std::cos(azimuth),
                                radius * std::sin(polar) * std::sin(azimuth),
                                radius * std::cos(polar)});
    surface.source.push_back(static_cast<std::uint32_t>(surface.source.size()));
  };
  add(0.0, 0.0);
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t k = 0; k < sectors; ++k) {
      add(std::numbers::pi * i / rings, 2.0 * std::numbers::pi * k / sectors);
    }
  }
  add(std::numbers::pi, 0.0);
  const auto at = [&](std::uint32_t ring, std::uint32_t sector) {
    if (ring == 0) return 0U;
    if (ring == rings) return (rings - 1) * sectors + 1;
    return 1 + (ring - 1) * sectors + sector % sectors;
  };
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t k = 0; k < sectors; ++k) {
      if (i > 0) surface.triangles.push_back({at(i, k), at(i + 1, k), at(i, k + 1)});
      if (i + 1 < rings)
        surface.triangles.push_back({at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)});
    }
  }
  set_normals_from_faces(surface);
  return surface;
}

SurfaceMesh without_faces(SurfaceMesh surface, const std::function<bool(std::size_t)>& drop) {
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    if (!drop(f)) kept.push_back(surface.triangles[f]);
  }
  surface.triangles = kept;
  return surface;
}

SurfaceMesh joined(const SurfaceMesh& a, const SurfaceMesh& b, const Eigen::Vector3d& offset) {
  SurfaceMesh both = a;
  const auto base = static_cast<std::uint32_t>(a.vertices.size());
  for (std::size_t v = 0; v < b.vertices.size(); ++v) {
    const auto& p = b.vertices[v];
    both.vertices.push_back({p[0] + offset.x(), p[1] + offset.y(), p[2] + offset.z()});
    both.normals.push_back(b.normals[v]);
    both.source.push_back(base + b.source[v]);
  }
  for (const auto& [i, j, k] : b.triangles) {
    both.triangles.push_back({i + base, j + base, k + base});
  }
  return both;
}

}  // namespace viewgain::test
