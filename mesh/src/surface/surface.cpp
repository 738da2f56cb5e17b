// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/surface.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "advancing_front.hpp"
#include "face_components.hpp"
#include "point_cleaning.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/mix64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::Point3;
using Triangle = std::array<std::uint32_t, 3>;

constexpr double kDuplicate = 0.05;    // nearer points are one [spacings]
constexpr double kMinArea = 1e-6;      // twice that of a triangle with a normal [spacings²]
constexpr double kMinDistance = 0.25;  // of vertices after smoothing [spacings]

void check(std::span<const OrientedPoint> points, const SurfaceConfig& config) {
  const auto refuse = [](const std::string& what, double value) {
    throw Error(ErrorCode::invalid_argument, what + ", not " + short_text(value));
  };
  if (!std::isfinite(config.spacing) || config.spacing <= 0) {
    refuse("the spacing must be positive and finite", config.spacing);
  }
  if (!std::isfinite(config.max_edge) || config.max_edge <= 0) {
    refuse("the longest edge must be positive and finite", config.max_edge);
  }
  if (!std::isfinite(config.join_distance) || config.join_distance <= 0) {
    refuse("the join distance must be positive and finite", config.join_distance);
  }
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::capacity, "2^32 points or more");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const double x : points[i].position) {
      if (!std::isfinite(x)) {
        throw Error(ErrorCode::invalid_argument,
                    "a coordinate of point " + std::to_string(i) + " is not finite");
      }
    }
  }
}

// The points worked on: `points` are those of the input that `index` names.
struct Selection {
  std::vector<std::uint32_t> index;
  std::vector<OrientedPoint> points;

  void keep(std::span<const std::uint32_t> kept) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      index[k] = index[kept[k]];
      points[k] = points[kept[k]];
    }
    index.resize(kept.size());
    points.resize(kept.size());
  }
};

Eigen::Vector3d vector_of(const Point3& p) { return {p[0], p[1], p[2]}; }

// In units of the spacing from the first point. The offsets of a ten-thousandth take away
// ties: points on a lattice leave CGAL choices that it makes by addresses in
// memory.
std::vector<Point3> triangulation_points(std::span<const OrientedPoint> points, double spacing) {
  std::vector<Point3> scaled(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double offset = unit_number(mix64((3 * i + k) * kMixStep));
      scaled[i][k] =
          (points[i].position[k] - points[0].position[k]) / spacing + 1e-4 * (offset - 0.5);
    }
  }
  return scaled;
}

Eigen::Vector3d area_vector(std::span<const OrientedPoint> points, const Triangle& t) {
  const Eigen::Vector3d a = vector_of(points[t[0]].position);
  return (vector_of(points[t[1]].position) - a).cross(vector_of(points[t[2]].position) - a);
}

// Turns components round whose faces look away from the free side in the eyes of most corners; a
// hint counts by the cosine, as one along the face says nothing. Without any hint the side is that
// in which the first face's vertices rise.
void orient(std::vector<Triangle>& triangles, const detail::FaceComponents& components,
            std::span<const OrientedPoint> points) {
  std::vector<double> vote(components.count, 0.0);
  std::vector<bool> falls(components.count, false);  // the first face's vertices
  for (std::size_t f = triangles.size(); f-- > 0;) {
    const Triangle& t = triangles[f];
    const Eigen::Vector3d normal = area_vector(points, t).stableNormalized();
    const std::uint32_t c = components.of_face[f];
    for (const std::uint32_t v : t) {
      vote[c] += normal.dot(vector_of(points[v].toward_free).stableNormalized());
    }
    falls[c] = t[1] > t[2];
  }
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const std::uint32_t c = components.of_face[f];
    if (vote[c] < 0 || (vote[c] == 0 && falls[c])) std::swap(triangles[f][1], triangles[f][2]);
  }
}

SurfaceMesh assemble(const Selection& selection, const std::vector<Triangle>& triangles) {
  SurfaceMesh mesh;
  std::vector<Eigen::Vector3d> normals(selection.points.size(), Eigen::Vector3d::Zero());
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d area = area_vector(selection.points, t);
    for (const std::uint32_t v : t) normals[v] += area;
  }
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertex_of(selection.points.size(), kUnused);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) vertex_of[v] = 0;
  }
  for (std::size_t v = 0; v < vertex_of.size(); ++v) {
    if (vertex_of[v] == kUnused) continue;
    vertex_of[v] = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(selection.points[v].position);
    mesh.source.push_back(selection.index[v]);
    const Eigen::Vector3d n = normals[v].stableNormalized();
    mesh.normals.push_back({n.x(), n.y(), n.z()});
  }
  for (const Triangle& t : triangles) {
    mesh.triangles.push_back({vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]});
  }
  return mesh;
}

}  // namespace

SurfaceMesh reconstruct_surface(std::span<const OrientedPoint> points, const SurfaceConfig& config,
                                const ExecConfig& exec) {
  check(points, config);
  Selection selection{std::vector<std::uint32_t>(points.size()), {points.begin(), points.end()}};
  for (std::uint32_t i = 0; i < points.size(); ++i) selection.index[i] = i;
  const auto keep_apart = [&](std::span<const Point3> positions, double distance) {
    selection.keep(detail::apart(positions, distance * config.spacing));
  };
  keep_apart(detail::positions_of(selection.points), kDuplicate);
  selection.keep(detail::large_components(selection.points, config));
  if (selection.points.size() < 3) return {};

  const std::vector<Point3> positions = detail::smoothed(selection.points, config, exec);
  for (std::size_t i = 0; i < positions.size(); ++i) selection.points[i].position = positions[i];
  keep_apart(positions, kMinDistance);
  if (selection.points.size() < 3) return {};

  std::vector<Triangle> triangles = detail::advancing_front(
      triangulation_points(selection.points, config.spacing), config.max_edge);
  std::erase_if(triangles, [&](const Triangle& t) {
    return area_vector(selection.points, t).norm() < kMinArea * config.spacing * config.spacing;
  });
  detail::drop_non_manifold(triangles);
  detail::FaceComponents components = detail::face_components(triangles);
  detail::drop_small(triangles, components, config.min_component);
  orient(triangles, components, selection.points);
  return assemble(selection, triangles);
}

}  // namespace viewgain
