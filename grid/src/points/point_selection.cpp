// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "point_selection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "point_cells.hpp"

namespace viewgain::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSameSide = 0.5;  // least cosine between normals of one side
constexpr int kDirections = 8;     // of the rim of a disc
constexpr double kLeastGap = 0.4;  // of `cover`: nearer points are not put back

// Points with one array per component, so that a loop over them can be vectorised.
struct Columns {
  std::vector<double> x, y, z, nx, ny, nz, evidence;

  void clear() {
    for (auto* column : {&x, &y, &z, &nx, &ny, &nz, &evidence}) column->clear();
  }
  void add(const PooledPoint& p) {
    x.push_back(p.position.x());
    y.push_back(p.position.y());
    z.push_back(p.position.z());
    nx.push_back(p.toward_free.x());
    ny.push_back(p.toward_free.y());
    nz.push_back(p.toward_free.z());
    evidence.push_back(p.evidence);
  }
};

// Is the rim of the disc of radius `cover` in the point's tangent plane within `cover` of others?
bool rim_is_covered(const PooledPoint& point, double cover, const std::vector<Vector3d>& others) {
  const Vector3d u = point.toward_free.unitOrthogonal(), w = point.toward_free.cross(u);
  for (int k = 0; k < kDirections; ++k) {
    const double turn = 2 * std::numbers::pi * k / kDirections;
    const Vector3d rim = point.position + cover * (std::cos(turn) * u + std::sin(turn) * w);
    if (std::none_of(others.begin(), others.end(), [&](const Vector3d& other) {
          return (other - rim).squaredNorm() <= cover * cover;
        })) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::uint8_t> well_supported(const std::vector<PooledPoint>& points, double radius,
                                         double share, ThreadPool& pool) {
  std::vector<std::uint8_t> kept(points.size(), 1);
  if (share == 0) return kept;
  PointCells<std::size_t> cells(radius);
  for (std::size_t i = 0; i < points.size(); ++i) cells.at(points[i].position).push_back(i);
  const std::vector<const std::vector<std::size_t>*> groups = cells.groups();
  pool.for_each_chunk(groups.size(), 4, [&](std::size_t begin, std::size_t end) {
    Columns near;
    for (std::size_t g = begin; g < end; ++g) {
      near.clear();
      cells.for_each_near(points[groups[g]->front()].position,
                          [&](std::size_t j) { near.add(points[j]); });
      for (const std::size_t i : *groups[g]) {
        const PooledPoint& p = points[i];
        // evidence >= share · quartile, without sorting: more than 3/4 of them must not exceed it.
        int all = 0, below = 0;
        for (std::size_t j = 0; j < near.x.size(); ++j) {
          const double dx = near.x[j] - p.position.x(), dy = near.y[j] - p.position.y(),
                       dz = near.z[j] - p.position.z();
          const double cosine = near.nx[j] * p.toward_free.x() + near.ny[j] * p.toward_free.y() +
                                near.nz[j] * p.toward_free.z();
          const int counts = (dx * dx + dy * dy + dz * dz <= radius * radius ? 1 : 0) &
                             (cosine >= kSameSide ? 1 : 0);
          all += counts;
          below += counts & (share * near.evidence[j] <= p.evidence ? 1 : 0);
        }
        kept[i] = below > all * 3 / 4 ? 1 : 0;
      }
    }
  });
  return kept;
}

std::vector<std::size_t> thinned(const std::vector<PooledPoint>& points, double min_distance,
                                 double cover, ThreadPool& pool) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (min_distance == 0) return order;
  // Ties by position, as the points' order tells how the map is stored.
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      const Vector3d& p = points[i].position;
      return std::tuple(-static_cast<std::int64_t>(points[i].hits), p.x(), p.y(), p.z());
    };
    return key(a) < key(b);
  });
  PointCells<std::size_t> cells(std::max(min_distance, 2 * cover));
  const auto for_each_beside = [&](std::size_t i, const auto& f) {
    cells.for_each_near(points[i].position, [&](std::size_t j) {
      if (points[j].toward_free.dot(points[i].toward_free) >= 0) {
        f(j, (points[j].position - points[i].position).squaredNorm());
      }
    });
  };
  std::vector<std::size_t> taken, rest;
  for (const std::size_t i : order) {
    bool crowded = false;
    for_each_beside(i, [&](std::size_t, double squared) {
      crowded = crowded || squared < min_distance * min_distance;
    });
    (crowded ? rest : taken).push_back(i);
    if (!crowded) cells.at(points[i].position).push_back(i);
  }
  const auto leaves_hole = [&](std::size_t i, std::vector<Vector3d>& others) {
    others.clear();
    bool is_beside = false;
    for_each_beside(i, [&](std::size_t j, double squared) {
      is_beside = is_beside || squared < std::pow(kLeastGap * cover, 2);
      if (squared <= 4 * cover * cover) others.push_back(points[j].position);
    });
    return !is_beside && !rim_is_covered(points[i], cover, others);
  };
  // Putting points back only closes holes, so that the second pass checks these candidates alone.
  std::vector<std::uint8_t> holes(rest.size());
  pool.for_each_chunk(rest.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Vector3d> others;
    for (std::size_t k = begin; k < end; ++k) holes[k] = leaves_hole(rest[k], others) ? 1 : 0;
  });
  std::vector<Vector3d> others;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    if (holes[k] == 0 || !leaves_hole(rest[k], others)) continue;
    taken.push_back(rest[k]);
    cells.at(points[rest[k]].position).push_back(rest[k]);
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

}  // namespace viewgain::detail
