// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/jump_edge_filter.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kMinAngle = 1 * kDegree;
constexpr double kMaxAngle = 10 * kDegree;
constexpr double kAngleSlack = 1e-9;  // bounds given in degrees and converted

/// Is the edge from p to q within the angle of p's viewing ray? By the cross product, which keeps
/// its digits at small angles.
bool along_ray(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double sin2_angle) {
  const Eigen::Vector3d edge = q - p;
  return p.cross(edge).squaredNorm() < sin2_angle * p.squaredNorm() * edge.squaredNorm();
}

}  // namespace

JumpEdgeFilter::JumpEdgeFilter(const PinholeCamera& camera, const JumpEdgeFilter::Config& config)
    : camera_(camera), config_(config) {
  camera_.validate();
  if (!(config_.angle >= kMinAngle - kAngleSlack && config_.angle <= kMaxAngle + kAngleSlack)) {
    throw Error(ErrorCode::invalid_argument, "jump-edge angle must be in 1..10 degrees, not " +
                                                 short_text(config_.angle / kDegree));
  }
  rays_ = camera_.ray_table();
}

std::size_t JumpEdgeFilter::apply(DepthFrame& frame) const {
  check_frame_size(frame, camera_);
  const std::size_t pixels = rays_.size();
  const auto width = static_cast<std::size_t>(camera_.width);
  const auto height = static_cast<std::size_t>(camera_.height);

  // Zero where there is no reading; a reading cannot be at the camera's centre.
  std::vector<Eigen::Vector3d> points(pixels, Eigen::Vector3d::Zero());
  std::vector<double> squared_ranges(pixels, 0.0);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float depth = frame.depth[i];
    if (!(depth > 0 && std::isfinite(depth)) || !rays_[i].allFinite()) continue;
    points[i] = static_cast<double>(depth) * rays_[i];
    squared_ranges[i] = points[i].squaredNorm();
  }

  const double sin_angle = std::sin(config_.angle);
  const double sin2_angle = sin_angle * sin_angle;
  std::size_t removed = 0;
  for (std::size_t v = 0; v < height; ++v) {
    for (std::size_t u = 0; u < width; ++u) {
      const std::size_t p = v * width + u;
      if (!(squared_ranges[p] > 0)) continue;
      bool flying = false;
      for (std::size_t j = v > 0 ? v - 1 : v; j <= v + 1 && j < height && !flying; ++j) {
        for (std::size_t i = u > 0 ? u - 1 : u; i <= u + 1 && i < width && !flying; ++i) {
          const std::size_t q = j * width + i;
          if (q == p || !(squared_ranges[q] > 0)) continue;
          if (!config_.two_sided && !(squared_ranges[q] < squared_ranges[p])) continue;
          flying = along_ray(points[p], points[q], sin2_angle);
        }
      }
      if (!flying) continue;
      frame.depth[p] = DepthFrame::kInvalid;
      if (!frame.amplitude.empty()) frame.amplitude[p] = 0;
      ++removed;
    }
  }
  return removed;
}

}  // namespace viewgain
