// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_cleaning.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

PointGrid::PointGrid(std::span<const Point3> points, double cell_size)
    : inverse_cell_size_(1.0 / cell_size), order_(points.size()), sorted_(points.size()) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3& p = points[i];
    keyed[i] = {key_of(cell_of(p[0]), cell_of(p[1]), cell_of(p[2])), static_cast<std::uint32_t>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    order_[i] = keyed[i].second;
    sorted_[i] = points[keyed[i].second];
    if (i == 0 || keyed[i].first != keyed[i - 1].first) ++count;
  }
  const auto bits = static_cast<unsigned>(std::bit_width(2 * count | 1U));  // 1 for no points
  cells_.resize(std::size_t{1} << bits);
  shift_ = 64U - bits;
  for (std::uint32_t i = 0; i < keyed.size(); ++i) {
    Cell& cell = cells_[slot_of(keyed[i].first)];
    if (cell.end == 0) cell = {keyed[i].first, i, i};
    cell.end = i + 1;
  }
}

namespace {

constexpr double kMaxMove = 1.25;  // larger distance from the fitted surface: an outlier [spacings]
constexpr std::size_t kMinFit = 10;  // points for a quadric; it has six coefficients

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

double dot(const Point3& a, const Point3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Radius of the disc that contains smoothing_neighbors points at a density of one per spacing²
// [spacings].
double disc_radius(const SurfaceConfig& config) {
  return std::sqrt(static_cast<double>(config.smoothing_neighbors) / std::numbers::pi);
}

// Cell size for searches around points of fine and coarse spacings [m].
double middle_spacing(std::span<const OrientedPoint> points, const SurfaceConfig& config) {
  double largest = config.spacing;
  for (const OrientedPoint& p : points) largest = std::max(largest, spacing_at(p, config));
  return largest > config.spacing ? std::sqrt(largest * config.spacing) : config.spacing;
}

using Neighbor = std::pair<double, std::uint32_t>;  // squared distance, index

class Smoother {
 public:
  Smoother(std::span<const OrientedPoint> points, std::span<const Point3> positions,
           const PointGrid& grid, const SurfaceConfig& config)
      : points_(points), positions_(positions), grid_(grid), config_(config) {}

  Point3 operator()(std::uint32_t i, std::vector<Neighbor>& buffer) const {
    find_neighbors(i, buffer);
    if (buffer.size() < kMinFit) return positions_[i];
    return moved(i, buffer);
  }

 private:
  // The points in the disc. If points are sparser, the nearest smoothing_neighbors within the
  // longest edge of a triangle.
  void find_neighbors(std::uint32_t i, std::vector<Neighbor>& found) const {
    const std::size_t wanted = config_.smoothing_neighbors;
    const double spacing = spacing_at(points_[i], config_);
    const double disc = spacing * disc_radius(config_);
    const double reach = std::max(disc, config_.max_edge * spacing);
    const auto collect = [&](double radius) {
      found.clear();
      grid_.for_each_within(positions_[i], radius, [&](std::uint32_t j, double d2) {
        // Opposed hints distinguish the two sides of a thin part.
        if (dot(points_[i].toward_free, points_[j].toward_free) >= 0) found.emplace_back(d2, j);
      });
    };
    collect(disc);
    if (found.size() >= wanted || reach <= disc) return;
    collect(reach);
    if (found.size() <= wanted) return;
    std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(wanted - 1),
                     found.end());
    found.resize(wanted);
  }

  Point3 moved(std::uint32_t i, const std::vector<Neighbor>& neighbors) const {
    const Eigen::Map<const Eigen::Vector3d> p(positions_[i].data());
    const double spacing = spacing_at(points_[i], config_);
    const auto offset = [&](const Neighbor& n) -> Eigen::Vector3d {
      return (Eigen::Map<const Eigen::Vector3d>(positions_[n.second].data()) - p) / spacing;
    };
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const Neighbor& n : neighbors) {
      const Eigen::Vector3d d = offset(n);
      mean += d;
      scatter.noalias() += d * d.transpose();
    }
    mean /= static_cast<double>(neighbors.size());
    scatter -= static_cast<double>(neighbors.size()) * mean * mean.transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
    axes.computeDirect(scatter);
    const Eigen::Vector3d w = axes.eigenvectors().col(0);
    const Eigen::Vector3d u = axes.eigenvectors().col(2);
    const Eigen::Vector3d v = axes.eigenvectors().col(1);

    using Vector6d = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, 6, 6> normal_matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Vector6d right = Vector6d::Zero();
    for (const Neighbor& n : neighbors) {
      const Eigen::Vector3d d = offset(n);
      const double s = u.dot(d), t = v.dot(d);
      const Vector6d row = (Vector6d() << 1, s, t, s * s, s * t, t * t).finished();
      normal_matrix.noalias() += row * row.transpose();
      right += w.dot(d) * row;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> ldlt(normal_matrix);
    const double height = ldlt.solve(right)[0];
    const Vector6d pivots = ldlt.vectorD();
    // Points on a line or a conic determine no quadric.
    if (!(pivots.minCoeff() > 1e-8 * pivots.maxCoeff())) return positions_[i];
    if (std::abs(height) > kMaxMove) {
      constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
      return {kNaN, kNaN, kNaN};
    }
    const Eigen::Vector3d moved = p + height * spacing * w;
    return {moved.x(), moved.y(), moved.z()};
  }

  std::span<const OrientedPoint> points_;
  std::span<const Point3> positions_;
  const PointGrid& grid_;
  const SurfaceConfig& config_;
};

}  // namespace

std::vector<Point3> positions_of(std::span<const OrientedPoint> points) {
  std::vector<Point3> positions(points.size());
  std::transform(points.begin(), points.end(), positions.begin(),
                 [](const OrientedPoint& p) { return p.position; });
  return positions;
}

std::vector<std::uint32_t> large_components(std::span<const OrientedPoint> points,
                                            const SurfaceConfig& config) {
  const std::vector<Point3> positions = positions_of(points);
  const PointGrid grid(positions, config.join_distance * middle_spacing(points, config));
  std::vector<std::uint32_t> parent(points.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (const std::uint32_t i : grid.order()) {
    const double spacing = spacing_at(points[i], config);
    std::uint32_t root = root_of(parent, i);
    grid.for_each_within(positions[i], config.join_distance * spacing,
                         [&](std::uint32_t j, double) {
                           if (j >= i && spacing_at(points[j], config) == spacing)
                             return;  // found again from j
                           const std::uint32_t other = root_of(parent, j);
                           parent[std::max(root, other)] = std::min(root, other);
                           root = std::min(root, other);
                         });
  }
  std::vector<std::uint32_t> size(points.size(), 0);
  for (std::uint32_t i = 0; i < parent.size(); ++i) ++size[root_of(parent, i)];
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    if (size[root_of(parent, i)] >= config.min_component) kept.push_back(i);
  }
  return kept;
}

std::vector<Point3> smoothed(std::span<const OrientedPoint> points, const SurfaceConfig& config,
                             const ExecConfig& exec) {
  std::vector<Point3> positions = positions_of(points);
  if (config.smoothing_neighbors == 0) return positions;
  const PointGrid grid(positions, middle_spacing(points, config) * disc_radius(config));
  const Smoother smoother(points, positions, grid, config);
  std::vector<Point3> result(points.size());
  ThreadPool pool(exec.num_threads);
  pool.for_each_chunk(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> buffer;
    for (std::size_t k = begin; k < end; ++k) {
      const std::uint32_t i = grid.order()[k];
      result[i] = smoother(i, buffer);
    }
  });
  return result;
}

std::vector<std::uint32_t> apart(std::span<const Point3> points, double min_distance) {
  std::vector<std::uint32_t> finite;
  std::vector<Point3> candidates;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i][0])) continue;
    finite.push_back(i);
    candidates.push_back(points[i]);
  }
  const PointGrid grid(candidates, min_distance);
  std::vector<bool> dropped(candidates.size(), false);
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < candidates.size(); ++i) {
    if (dropped[i]) continue;
    kept.push_back(finite[i]);
    grid.for_each_within(candidates[i], min_distance, [&](std::uint32_t j, double) {
      if (j > i) dropped[j] = true;
    });
  }
  return kept;
}

}  // namespace viewgain::detail
