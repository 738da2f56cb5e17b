// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewgain/mesh/patch.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>

#include "region_grower.hpp"
#include "surface/surface_access.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::detail {

RegionGrower::RegionGrower(const SurfaceMesh& surface)
    : surface_(surface),
      first_(surface.vertices.size() + 1, 0),
      distance_(surface.vertices.size(), std::numeric_limits<double>::infinity()) {
  // Each corner of a face has two neighbours in that face.
  for (const auto& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) first_[v + 1] += 2;
  }
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  neighbors_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const auto& [a, b, c] : surface.triangles) {
    neighbors_[next[a]++] = b;
    neighbors_[next[a]++] = c;
    neighbors_[next[b]++] = c;
    neighbors_[next[b]++] = a;
    neighbors_[next[c]++] = a;
    neighbors_[next[c]++] = b;
  }
}

std::vector<std::uint32_t> RegionGrower::grow(std::span<const std::uint32_t> seeds, double depth,
                                              double max_turn) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : seeds) mean += normal(surface_, v);
  std::vector<std::uint32_t> region;
  if (mean.isZero(0)) return region;
  mean.normalize();
  const double min_cosine = std::cos(max_turn);

  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto offer = [&](std::uint32_t v, double distance) {
    if (!(distance <= depth) || distance >= distance_[v]) return;
    if (!(normal(surface_, v).dot(mean) > min_cosine)) return;
    if (std::isinf(distance_[v])) region.push_back(v);
    distance_[v] = distance;
    queue.emplace(distance, v);
  };
  for (const std::uint32_t v : seeds) offer(v, 0.0);
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > distance_[v]) continue;
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      const std::uint32_t n = neighbors_[i];
      offer(n, distance + (position(surface_, n) - position(surface_, v)).norm());
    }
  }
  for (const std::uint32_t v : region) distance_[v] = std::numeric_limits<double>::infinity();
  std::sort(region.begin(), region.end());
  return region;
}

}  // namespace viewgain::detail

namespace viewgain {
namespace {

constexpr double kMaxCondition = 1e3;

// Largest uncertainty of the slope: above it, the curvature can come from noise alone and would
// turn the extrapolated view.
constexpr double kMaxSlopeSigma = 0.2;

// Sine of the angle under which `outward` counts as parallel to the normal.
constexpr double kParallelSine = 1e-8;

// The points in the patch's frame, centred and divided by one common spread. The condition number
// then shows whether their layout determines a fit; a long, narrow band does not.
struct LayoutInPlane {
  Eigen::Matrix3Xd local;  // u, v, w [m]
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double spread = 0;  // [m]

  LayoutInPlane(std::span<const Eigen::Vector3d> points, const QuadraticPatch& frame)
      : local(3, static_cast<Eigen::Index>(points.size())) {
    for (Eigen::Index i = 0; i < local.cols(); ++i) {
      local.col(i) = frame.axes.transpose() * (points[static_cast<std::size_t>(i)] - frame.origin);
    }
    if (points.empty()) return;
    center = local.topRows<2>().rowwise().mean();
    spread = std::sqrt((local.topRows<2>().colwise() - center).squaredNorm() /
                       (2.0 * static_cast<double>(points.size())));
  }
};

template <int N>
struct Solution {
  Eigen::Matrix<double, N, 1> x;
  Eigen::Matrix<double, N, N> factor;  // (AᵀA)⁻¹ = factor factorᵀ
  bool determined = false;
};

// Solves the normal equations, which lose at most six of sixteen digits for condition numbers below
// 1e3.
template <int N>
Solution<N> least_squares(const Eigen::Matrix<double, Eigen::Dynamic, N>& A,
                          const Eigen::VectorXd& b) {
  using Square = Eigen::Matrix<double, N, N>;
  Solution<N> solution;
  const Square square = A.transpose() * A;
  const Eigen::JacobiSVD<Square, Eigen::NoQRPreconditioner> svd(square, Eigen::ComputeFullV);
  const Eigen::Matrix<double, N, 1> squares = svd.singularValues();  // decreasing
  solution.determined = squares[0] < kMaxCondition * kMaxCondition * squares[N - 1];
  if (!solution.determined) return solution;
  solution.factor = svd.matrixV() * squares.cwiseSqrt().cwiseInverse().asDiagonal();
  solution.x = solution.factor * (solution.factor.transpose() * (A.transpose() * b));
  return solution;
}

// Standard deviation of the slope dw/du at (u, v), if the residuals are independent noise.
double slope_sigma(const Solution<6>& solution, double residual_sum, Eigen::Index points,
                   const LayoutInPlane& layout, double u, double v) {
  const double s = (u - layout.center.x()) / layout.spread;
  const double t = (v - layout.center.y()) / layout.spread;
  Eigen::Matrix<double, 6, 1> gradient;
  gradient << 2.0 * s, t, 0.0, 1.0, 0.0, 0.0;
  const double variance = residual_sum / static_cast<double>(points - 6);
  return std::sqrt(variance) * (solution.factor.transpose() * gradient).norm() / layout.spread;
}

bool fit_quadric(const LayoutInPlane& layout, QuadraticPatch& patch) {
  const Eigen::Index n = layout.local.cols();
  // Six points always fit exactly, so the fit could not be judged.
  if (n < 7 || !(layout.spread > 0)) return false;
  const Eigen::ArrayXd s = (layout.local.row(0).array() - layout.center.x()) / layout.spread;
  const Eigen::ArrayXd t = (layout.local.row(1).array() - layout.center.y()) / layout.spread;
  Eigen::Matrix<double, Eigen::Dynamic, 6> A(n, 6);
  A << s * s, s * t, t * t, s, t, Eigen::ArrayXd::Ones(n);
  const Eigen::VectorXd w = layout.local.row(2);
  const Solution<6> solution = least_squares<6>(A, w);
  if (!solution.determined) return false;
  const double residual_sum = (A * solution.x - w).squaredNorm();
  if (slope_sigma(solution, residual_sum, n, layout, patch.depth, 0.0) > kMaxSlopeSigma) {
    return false;
  }
  // Converts back from centred and scaled coordinates.
  const double h = layout.spread;
  const double u0 = layout.center.x();
  const double v0 = layout.center.y();
  const double a = solution.x[0] / (h * h);
  const double b = solution.x[1] / (h * h);
  const double c = solution.x[2] / (h * h);
  const double d = solution.x[3] / h;
  const double e = solution.x[4] / h;
  patch.coefficients = {a,
                        b,
                        c,
                        d - 2.0 * a * u0 - b * v0,
                        e - 2.0 * c * v0 - b * u0,
                        solution.x[5] + a * u0 * u0 + b * u0 * v0 + c * v0 * v0 - d * u0 - e * v0};
  return true;
}

void fit_plane(const LayoutInPlane& layout, QuadraticPatch& patch) {
  const Eigen::Index n = layout.local.cols();
  patch.planar = true;
  if (n < 3 || !(layout.spread > 0)) return;
  Eigen::Matrix<double, Eigen::Dynamic, 3> A(n, 3);
  A << (layout.local.row(0).transpose().array() - layout.center.x()) / layout.spread,
      (layout.local.row(1).transpose().array() - layout.center.y()) / layout.spread,
      Eigen::ArrayXd::Ones(n);
  const Solution<3> solution = least_squares<3>(A, layout.local.row(2));
  if (!solution.determined) return;
  const double d = solution.x[0] / layout.spread;
  const double e = solution.x[1] / layout.spread;
  patch.coefficients = {0, 0, 0,
                        d, e, solution.x[2] - d * layout.center.x() - e * layout.center.y()};
}

double height(const std::array<double, 6>& k, double u, double v) {
  return k[0] * u * u + k[1] * u * v + k[2] * v * v + k[3] * u + k[4] * v + k[5];
}

}  // namespace

Eigen::Vector3d QuadraticPatch::point(double u, double v) const {
  return origin + axes * Eigen::Vector3d(u, v, height(coefficients, u, v));
}

Eigen::Vector3d QuadraticPatch::normal(double u, double v) const {
  const auto& [a, b, c, d, e, f] = coefficients;
  return axes *
         Eigen::Vector3d(-(2.0 * a * u + b * v + d), -(b * u + 2.0 * c * v + e), 1.0).normalized();
}

QuadraticPatch fit_patch(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& outward, const Eigen::Vector3d& normal) {
  const bool finite =
      origin.allFinite() && outward.allFinite() && normal.allFinite() &&
      std::all_of(points.begin(), points.end(), [](const auto& p) { return p.allFinite(); });
  if (!finite) refuse("fit_patch: all numbers must be finite");
  const Eigen::Vector3d w = normal.stableNormalized();
  const Eigen::Vector3d direction = outward.stableNormalized();
  const Eigen::Vector3d across = direction - w * w.dot(direction);
  if (w.isZero(0) || !(across.norm() > kParallelSine)) {
    refuse("fit_patch: outward is parallel to the normal, or one of the two vectors is zero");
  }
  QuadraticPatch patch;
  patch.origin = origin;
  // Orthogonalises again, because a short difference has a large relative error.
  const Eigen::Vector3d u = across.normalized();
  patch.axes.col(0) = (u - w * w.dot(u)).normalized();
  patch.axes.col(1) = w.cross(patch.axes.col(0));
  patch.axes.col(2) = w;

  const LayoutInPlane layout(points, patch);
  const Eigen::Index n = layout.local.cols();
  if (n == 0) {
    patch.planar = true;
    return patch;
  }
  patch.depth = std::max(0.0, -layout.local.row(0).minCoeff());
  if (!fit_quadric(layout, patch)) fit_plane(layout, patch);
  double sum = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double residual =
        layout.local(2, i) - height(patch.coefficients, layout.local(0, i), layout.local(1, i));
    sum += residual * residual;
  }
  patch.rms = std::sqrt(sum / static_cast<double>(n));
  return patch;
}

std::vector<std::uint32_t> grow_region(const SurfaceMesh& surface,
                                       std::span<const std::uint32_t> seeds, double depth,
                                       double max_turn) {
  detail::check_surface(surface);
  for (const std::uint32_t v : seeds) {
    if (v >= surface.vertices.size()) {
      refuse("grow_region: vertex " + std::to_string(v) + " does not exist");
    }
  }
  return detail::RegionGrower(surface).grow(seeds, depth, max_turn);
}

}  // namespace viewgain
