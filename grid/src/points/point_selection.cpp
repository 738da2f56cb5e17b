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
  std::vector<std::size_t> numbers;
  std::vector<double> x, y, z, nx, ny, nz, evidence;

  void add(std::size_t number, const PooledPoint& p) {
    numbers.push_back(number);
    x.push_back(p.position.x());
    y.push_back(p.position.y());
    z.push_back(p.position.z());
    nx.push_back(p.toward_free.x());
    ny.push_back(p.toward_free.y());
    nz.push_back(p.toward_free.z());
    evidence.push_back(p.evidence);
  }
};

// Counts the points within a radius that face the same way, and those of them whose evidence, times
// `share`, is at most the point's. Counts are doubles, because GCC does not vectorise with
// integers.
struct Supporters {
  double all = 0, below = 0;

  void add(const Columns& near, const PooledPoint& p, double radius, double share) {
    for (std::size_t j = 0; j < near.x.size(); ++j) {
      const double dx = near.x[j] - p.position.x(), dy = near.y[j] - p.position.y(),
                   dz = near.z[j] - p.position.z();
      const double cosine = near.nx[j] * p.toward_free.x() + near.ny[j] * p.toward_free.y() +
                            near.nz[j] * p.toward_free.z();
      const double within = dx * dx + dy * dy + dz * dz <= radius * radius ? 1.0 : 0.0;
      const double counts = cosine >= kSameSide ? within : 0.0;
      all += counts;
      below += share * near.evidence[j] <= p.evidence ? counts : 0.0;
    }
  }
};

// A selected point.
struct Taken {
  Vector3d position;
  std::size_t number;
};

// Whether the rim of the disc of radius `cover` in the point's tangent plane is within `cover` of
// others.
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
  PointCells<Columns> cells(radius);
  for (std::size_t i = 0; i < points.size(); ++i) cells.at(points[i].position).add(i, points[i]);
  const std::vector<const Columns*> groups = cells.buckets();
  pool.for_each_chunk(groups.size(), 4, [&](std::size_t begin, std::size_t end) {
    std::vector<const Columns*> near;
    for (std::size_t g = begin; g < end; ++g) {
      near.clear();
      const std::vector<std::size_t>& numbers = groups[g]->numbers;
      (void)cells.any_near(points[numbers.front()].position, cells.edge(),
                           [&](const Columns& columns) {
                             near.push_back(&columns);
                             return false;
                           });
      for (const std::size_t i : numbers) {
        Supporters supporters;
        for (const Columns* columns : near) supporters.add(*columns, points[i], radius, share);
        // evidence >= share · quartile, without sorting: more than 3/4 of them must not exceed it.
        kept[i] = supporters.below > std::floor(supporters.all * 3 / 4) ? 1 : 0;
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
  // Ties by position, because the points' order depends on the storage of the map.
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto key = [&](std::size_t i) {
      const Vector3d& p = points[i].position;
      return std::tuple(-static_cast<std::int64_t>(points[i].hits), p.x(), p.y(), p.z());
    };
    return key(a) < key(b);
  });
  PointCells<std::vector<Taken>> cells(std::max(min_distance, 2 * cover));
  // Whether f(position) is true for any selected point on the same side that passes
  // is_within(squared distance). is_within must reject points beyond the radius.
  const auto any_beside = [&](std::size_t i, double radius, const auto& is_within, const auto& f) {
    const PooledPoint& point = points[i];
    return cells.any_near(point.position, radius, [&](const std::vector<Taken>& bucket) {
      return std::any_of(bucket.begin(), bucket.end(), [&](const Taken& other) {
        return is_within((other.position - point.position).squaredNorm()) &&
               points[other.number].toward_free.dot(point.toward_free) >= 0 && f(other.position);
      });
    });
  };
  const auto is_any_closer = [&](std::size_t i, double distance) {
    return any_beside(
        i, distance, [&](double squared) { return squared < distance * distance; },
        [](const Vector3d&) { return true; });
  };
  std::vector<std::size_t> taken, rest;
  const auto take = [&](std::size_t i) {
    taken.push_back(i);
    cells.at(points[i].position).push_back({points[i].position, i});
  };
  for (const std::size_t i : order) {
    if (is_any_closer(i, min_distance)) {
      rest.push_back(i);
    } else {
      take(i);
    }
  }
  const auto leaves_hole = [&](std::size_t i, std::vector<Vector3d>& others) {
    if (is_any_closer(i, kLeastGap * cover)) return false;
    others.clear();
    (void)any_beside(
        i, 2 * cover, [&](double squared) { return squared <= 4 * cover * cover; },
        [&](const Vector3d& position) {
          others.push_back(position);
          return false;
        });
    return !rim_is_covered(points[i], cover, others);
  };
  // Reinserting points only closes holes, so the second pass only checks these candidates.
  std::vector<std::uint8_t> holes(rest.size());
  pool.for_each_chunk(rest.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Vector3d> others;
    for (std::size_t k = begin; k < end; ++k) holes[k] = leaves_hole(rest[k], others) ? 1 : 0;
  });
  std::vector<Vector3d> others;
  for (std::size_t k = 0; k < rest.size(); ++k) {
    if (holes[k] != 0 && leaves_hole(rest[k], others)) take(rest[k]);
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

}  // namespace viewgain::detail
