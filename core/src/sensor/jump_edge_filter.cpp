// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/jump_edge_filter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kMinAngle = 1 * kDegree;
constexpr double kMaxAngle = 10 * kDegree;
constexpr double kAngleSlack = 1e-9;  // for bounds that were converted from degrees

/// Whether the edge from p to q is within the angle of p's viewing ray. Uses the cross product,
/// which is accurate at small angles.
bool along_ray(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double sin2_angle) {
  const Eigen::Vector3d edge = q - p;
  return p.cross(edge).squaredNorm() < sin2_angle * p.squaredNorm() * edge.squaredNorm();
}

/// Two readings at ranges r and (1 + t) r, whose rays differ by the angle d, form an edge within
/// angle a of the farther ray if t² + 2 (1 + t) (1 - cos d) > sin² d / sin² a. Returns a bound on
/// (1 + t)² below which this is false for the smallest d in the image.
double smooth_ratio(const std::vector<Eigen::Vector3d>& rays, std::size_t width,
                    double sin2_angle) {
  double sin2_least = std::numeric_limits<double>::infinity();
  const auto look = [&](std::size_t p, std::size_t q) {
    const double squares = rays[p].squaredNorm() * rays[q].squaredNorm();
    if (!std::isfinite(squares)) return;  // no ray
    const double sin2 = rays[p].cross(rays[q]).squaredNorm() / squares;
    sin2_least = std::min(sin2_least, rays[p].dot(rays[q]) > 0 ? sin2 : 0.0);
  };
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const bool is_first = p % width == 0, is_last = p % width == width - 1;
    if (!is_last) look(p, p + 1);
    if (p + width >= rays.size()) continue;
    if (!is_first) look(p, p + width - 1);
    look(p, p + width);
    if (!is_last) look(p, p + width + 1);
  }
  // For t <= 1/2 and d <= 30 degrees, 2 (1 + t) (1 - cos d) is below 1.7 sin² d.
  if (!(sin2_least <= 0.25)) return 1;
  const double t = 0.99 * std::min(std::sqrt(sin2_least * (1 / sin2_angle - 1.7)), 0.5);
  return (1 + t) * (1 + t);
}

}  // namespace

JumpEdgeFilter::JumpEdgeFilter(const PinholeCamera& camera, const JumpEdgeFilter::Config& config)
    : camera_(camera), config_(config) {
  camera_.validate();
  if (!(config_.angle >= kMinAngle - kAngleSlack && config_.angle <= kMaxAngle + kAngleSlack)) {
    refuse("the jump-edge angle must be in 1..10 degrees, not " +
           short_text(config_.angle / kDegree));
  }
  rays_ = camera_.ray_table();
  const double sin_angle = std::sin(config_.angle);
  smooth_ = smooth_ratio(rays_, static_cast<std::size_t>(camera_.width), sin_angle * sin_angle);
}

std::size_t JumpEdgeFilter::apply(DepthFrame& frame) const {
  check_frame_size(frame, camera_);
  const auto width = static_cast<std::size_t>(camera_.width);
  const auto height = static_cast<std::size_t>(camera_.height);
  constexpr double kNone = std::numeric_limits<double>::infinity();

  // Depths as given and squared ranges, of the row above a pixel's, its own, and the one below.
  // kNone without a reading, also beyond the image.
  std::vector<float> depths(3 * width);
  std::vector<double> squares(3 * (width + 2), kNone), least(width + 2, kNone);
  const auto depth_row = [&](std::size_t v) { return &depths[v % 3 * width]; };
  const auto square_row = [&](std::size_t v) { return &squares[v % 3 * (width + 2) + 1]; };
  const auto load = [&](std::size_t v) {
    double* squared = square_row(v);
    if (v == height) {
      std::fill_n(squared, width, kNone);
      return;
    }
    const float* depth = &frame.depth[v * width];
    std::copy_n(depth, width, depth_row(v));
    for (std::size_t u = 0; u < width; ++u) {
      const double of_pixel =
          (static_cast<double>(depth[u]) * rays_[v * width + u]).squaredNorm();  // or not a number
      squared[u] = depth[u] > 0 && of_pixel < kNone ? of_pixel : kNone;
    }
  };
  const auto point = [&](std::size_t v, std::size_t u) -> Eigen::Vector3d {
    return static_cast<double>(depth_row(v)[u]) * rays_[v * width + u];
  };

  const double sin_angle = std::sin(config_.angle);
  const double sin2_angle = sin_angle * sin_angle;
  const auto is_flying = [&](std::size_t v, std::size_t u) {
    const double own = square_row(v)[u];
    for (std::size_t j = v > 0 ? v - 1 : v; j <= v + 1 && j < height; ++j) {
      for (std::size_t i = u > 0 ? u - 1 : u; i <= u + 1 && i < width; ++i) {
        const double other = square_row(j)[i];
        const double near = std::min(own, other), far = std::max(own, other);
        if (far < smooth_ * near || !(far < kNone)) continue;
        if (!config_.two_sided && !(other < own)) continue;
        if (along_ray(point(v, u), point(j, i), sin2_angle)) return true;
      }
    }
    return false;
  };

  std::size_t removed = 0;
  load(0);
  for (std::size_t v = 0; v < height; ++v) {
    load(v + 1);
    const double *above = square_row(v + 2), *own = square_row(v), *below = square_row(v + 1);
    // Smallest of three rows, to compare with all neighbours at once.
    for (std::size_t u = 0; u < width; ++u) {
      least[u + 1] = std::min(std::min(above[u], own[u]), below[u]);
    }
    for (std::size_t u = 0; u < width; ++u) {
      if (!(own[u] < kNone)) continue;
      const double nearest = std::min(std::min(least[u], least[u + 1]), least[u + 2]);
      if (!config_.two_sided && own[u] < smooth_ * nearest) continue;
      if (!is_flying(v, u)) continue;
      frame.depth[v * width + u] = DepthFrame::kInvalid;
      if (!frame.amplitude.empty()) frame.amplitude[v * width + u] = 0;
      ++removed;
    }
  }
  return removed;
}

}  // namespace viewgain
