// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/jump_edge_filter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "viewgain/core/error.hpp"
#include "viewgain/support/shared_rays.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
constexpr double kMinAngle = 1 * kDegree;
constexpr double kMaxAngle = 10 * kDegree;
constexpr double kAngleSlack = 1e-9;  // for bounds that were converted from degrees
constexpr std::size_t kRowChunk = 16;
constexpr float kNone = std::numeric_limits<float>::infinity();

double sin2_of(double angle) { return std::sin(angle) * std::sin(angle); }

/// Whether the edge from p to q is within the angle of p's viewing ray. Uses the cross product,
/// which is accurate at small angles.
bool along_ray(const Eigen::Vector3d& p, const Eigen::Vector3d& q, double sin2_angle) {
  const Eigen::Vector3d edge = q - p;
  return p.cross(edge).squaredNorm() < sin2_angle * p.squaredNorm() * edge.squaredNorm();
}

/// Two readings at ranges r and (1 + t) r, whose rays differ by the angle d, form an edge within
/// angle a of the farther ray if t² + 2 (1 + t) (1 - cos d) > sin² d / sin² a. Returns a bound on
/// 1 + t, below which this is false for d and all larger angles. Its margin is larger than the
/// rounding errors of ranges of float. Below 1 if there is no such bound.
float smooth_ratio(double sin2_d, double sin2_angle) {
  constexpr double kRounding = 1e-6;
  // For t <= 1/2 and d <= 30 degrees, 2 (1 + t) (1 - cos d) is below 1.7 sin² d.
  if (!(sin2_d <= 0.25)) return static_cast<float>(1 - kRounding);
  const double t = 0.99 * std::min(std::sqrt(sin2_d * (1 / sin2_angle - 1.7)), 0.5);
  return static_cast<float>((1 + t) * (1 - kRounding));
}

/// smooth_ratio() of each pixel for the neighbour whose ray is the nearest to its own.
std::vector<float> smooth_ratios(const std::vector<Eigen::Vector3d>& rays, std::size_t width,
                                 double sin2_angle) {
  std::vector<double> least(rays.size(), std::numeric_limits<double>::infinity());
  const auto look = [&](std::size_t p, std::size_t q) {
    const double squares = rays[p].squaredNorm() * rays[q].squaredNorm();
    if (!std::isfinite(squares)) return;  // no ray
    const double sin2 =
        rays[p].dot(rays[q]) > 0 ? rays[p].cross(rays[q]).squaredNorm() / squares : 0.0;
    least[p] = std::min(least[p], sin2);
    least[q] = std::min(least[q], sin2);
  };
  for (std::size_t p = 0; p < rays.size(); ++p) {
    const bool is_first = p % width == 0, is_last = p % width == width - 1;
    if (!is_last) look(p, p + 1);
    if (p + width >= rays.size()) continue;
    if (!is_first) look(p, p + width - 1);
    look(p, p + width);
    if (!is_last) look(p, p + width + 1);
  }
  std::vector<float> ratios;
  ratios.reserve(rays.size());
  for (const double sin2 : least) ratios.push_back(smooth_ratio(sin2, sin2_angle));
  return ratios;
}

}  // namespace

JumpEdgeFilter::JumpEdgeFilter(const PinholeCamera& camera, const JumpEdgeFilter::Config& config,
                               const ExecConfig& exec)
    : camera_(camera), config_(config) {
  camera_.validate();
  if (!(config_.angle >= kMinAngle - kAngleSlack && config_.angle <= kMaxAngle + kAngleSlack)) {
    refuse("the jump-edge angle must be in 1..10 degrees, not " +
           short_text(config_.angle / kDegree));
  }
  rays_ = shared_rays(camera_);
  double longest = 0;
  for (const Eigen::Vector3d& ray : *rays_) {
    if (ray.allFinite()) longest = std::max(longest, ray.stableNorm());
  }
  norms_.reserve(rays_->size());
  for (const Eigen::Vector3d& ray : *rays_) {
    norms_.push_back(ray.allFinite() ? static_cast<float>(ray.stableNorm() / longest) : kNone);
  }
  smooth_ = smooth_ratios(*rays_, static_cast<std::size_t>(camera_.width), sin2_of(config_.angle));
  pool_ = std::make_shared<ThreadPool>(exec.num_threads);
}

// Ranges are in units of the longest ray at depth 1: only their ratios matter.
struct JumpEdgeFilter::Image {
  const std::vector<float>& depth;
  const std::size_t width, height;
  const double sin2_angle;    // of the threshold
  std::vector<float> ranges;  // kNone without a reading; with a row of these above and below

  [[nodiscard]] const float* row(std::size_t v) const { return &ranges[(v + 1) * width]; }
  [[nodiscard]] float* row(std::size_t v) { return &ranges[(v + 1) * width]; }
};

bool JumpEdgeFilter::is_flying(const Image& image, std::size_t u, std::size_t v) const {
  const auto point = [&](std::size_t i) -> Eigen::Vector3d {
    return static_cast<double>(image.depth[i]) * (*rays_)[i];
  };
  const std::size_t i = v * image.width + u;
  const float range = image.row(v)[u];
  const Eigen::Vector3d p = point(i);
  for (std::size_t y = v > 0 ? v - 1 : v; y <= v + 1 && y < image.height; ++y) {
    for (std::size_t x = u > 0 ? u - 1 : u; x <= u + 1 && x < image.width; ++x) {
      const float other = image.row(y)[x];
      if (!(other < kNone)) continue;
      if (std::max(range, other) < smooth_[i] * std::min(range, other)) continue;
      const Eigen::Vector3d q = point(y * image.width + x);
      if (!config_.two_sided && !(q.squaredNorm() < p.squaredNorm())) continue;
      if (along_ray(p, q, image.sin2_angle)) return true;
    }
  }
  return false;
}

void JumpEdgeFilter::find(const Image& image, std::size_t begin, std::size_t end,
                          std::vector<std::uint8_t>& flying) const {
  const std::size_t width = image.width;
  // Nearest and farthest readings of three rows. Columns beyond the image have none.
  std::vector<float> nearest(width + 2, kNone), farthest(width + 2, 0.0F);
  std::vector<std::uint8_t> is_candidate(width);
  const auto or_zero = [](float range) { return range < kNone ? range : 0.0F; };
  for (std::size_t v = begin; v < end; ++v) {
    const float *own = image.row(v), *above = own - width, *below = own + width;
    const float* smooth = &smooth_[v * width];
    for (std::size_t u = 0; u < width; ++u) {
      nearest[u + 1] = std::min(std::min(above[u], own[u]), below[u]);
      farthest[u + 1] = std::max(std::max(or_zero(above[u]), or_zero(own[u])), or_zero(below[u]));
    }
    for (std::size_t u = 0; u < width; ++u) {
      const float near = std::min(std::min(nearest[u], nearest[u + 1]), nearest[u + 2]);
      const float far = std::max(std::max(farthest[u], farthest[u + 1]), farthest[u + 2]);
      const bool is_far = own[u] >= smooth[u] * near, is_near = far >= smooth[u] * own[u];
      is_candidate[u] = own[u] < kNone && (is_far || (config_.two_sided && is_near)) ? 1 : 0;
    }
    for (std::size_t u = 0; u < width; ++u) {
      if (is_candidate[u] != 0 && is_flying(image, u, v)) flying[v * width + u] = 1;
    }
  }
}

std::size_t JumpEdgeFilter::apply(DepthFrame& frame) const {
  check_frame_size(frame, camera_);
  const auto width = static_cast<std::size_t>(camera_.width);
  const auto height = static_cast<std::size_t>(camera_.height);
  Image image{frame.depth, width, height, sin2_of(config_.angle),
              std::vector<float>((height + 2) * width, kNone)};
  pool_->for_each_chunk(height, kRowChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin * width; i < end * width; ++i) {
      image.row(0)[i] = image.depth[i] > 0 ? image.depth[i] * norms_[i] : kNone;
    }
  });
  std::vector<std::uint8_t> flying(width * height, 0);
  pool_->for_each_chunk(height, kRowChunk, [&](std::size_t begin, std::size_t end) {
    find(image, begin, end, flying);
  });
  std::size_t removed = 0;
  for (std::size_t i = 0; i < flying.size(); ++i) {
    if (flying[i] == 0) continue;
    frame.depth[i] = DepthFrame::kInvalid;
    if (!frame.amplitude.empty()) frame.amplitude[i] = 0;
    ++removed;
  }
  return removed;
}

}  // namespace viewgain
