// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/pixel_scatter.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace viewgain::detail {
namespace {

constexpr double kMovedSigmas = 4;      // largest difference of both halves' means
constexpr double kMovedVariance = 2.5;  // times that of successive frames
constexpr double kLeastMove = 1e-6;     // [m]
constexpr int kReach = 6;               // half size of a window around an edge [px]
constexpr int kAround = 8;              // distance to search for a pixel's two sides [px]
constexpr double kJumpSigmas = 8;
constexpr double kJumpShare = 0.05;  // of the range
constexpr double kBetween = 0.2;     // largest fraction of pixels between the sides
constexpr double kStraight = 0.97;   // least fraction of an edge along one line

bool is_reading(float depth) { return std::isfinite(depth) && depth > 0; }

PixelScatter scatter_of_pixel(const std::vector<double>& ranges) {
  const std::size_t n = ranges.size();
  const auto count = static_cast<double>(n);
  PixelScatter pixel;
  pixel.median = median(ranges);
  double halves[2] = {0, 0};
  for (std::size_t i = 0; i < n; ++i) {
    pixel.mean += ranges[i] / count;
    halves[i < n / 2 ? 0 : 1] += ranges[i] / static_cast<double>(i < n / 2 ? n / 2 : n - n / 2);
  }
  double succession = 0;
  for (std::size_t i = 0; i < n; ++i) {
    pixel.variance += std::pow(ranges[i] - pixel.mean, 2) / (count - 1);
    if (i > 0) succession += std::pow(ranges[i] - ranges[i - 1], 2) / (2 * (count - 1));
  }
  const double apart = std::abs(halves[0] - halves[1]);
  const double by_chance = kMovedSigmas * std::sqrt(4 * succession / count) + kLeastMove;
  pixel.moves = apart > by_chance ||
                std::sqrt(pixel.variance) > std::sqrt(kMovedVariance * succession) + kLeastMove;
  return pixel;
}

// How often pixels near an edge read its far side.
class FarShare {
 public:
  FarShare(const PinholeCamera& camera, const std::vector<std::vector<float>>& depths,
           const std::vector<Eigen::Vector3d>& rays, const std::vector<PixelScatter>& pixels,
           double sigma)
      : width_(camera.width), height_(camera.height), pixels_(pixels), sigma_(sigma) {
    sides_.resize(pixels.size());
    for (int v = kAround; v < height_ - kAround; ++v) {
      for (int u = kAround; u < width_ - kAround; ++u) find_side(depths, rays, u, v);
    }
  }

  struct Side {
    double share = -1;         // fraction of far readings; -1: no edge
    double unlikeness = 0;     // unbiased p (1 - p)
    double near = 0, far = 0;  // along the ray [m]
  };
  [[nodiscard]] const Side& at(int u, int v) const { return sides_[index(u, v)]; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(u);
  }

  void find_side(const std::vector<std::vector<float>>& depths,
                 const std::vector<Eigen::Vector3d>& rays, int u, int v) {
    Side side;
    side.near = side.far = pixels_[index(u, v)].median;
    for (int y = v - kAround; y <= v + kAround; ++y) {
      for (int x = u - kAround; x <= u + kAround; ++x) {
        const double range = pixels_[index(x, y)].median;
        if (range == 0) return;
        side.near = std::min(side.near, range);
        side.far = std::max(side.far, range);
      }
    }
    const double jump = side.far - side.near;
    if (jump < std::max(kJumpSigmas * sigma_, kJumpShare * side.near)) return;
    int between = 0;
    for (int y = v - kAround; y <= v + kAround; ++y) {
      for (int x = u - kAround; x <= u + kAround; ++x) {
        const double place = (pixels_[index(x, y)].median - side.near) / jump;
        between += place > 0.3 && place < 0.7 ? 1 : 0;
      }
    }
    if (between > kBetween * (2 * kAround + 1) * (2 * kAround + 1)) return;
    const double middle = 0.5 * (side.near + side.far);
    double n = 0, far = 0;
    for (const std::vector<float>& frame : depths) {
      const float depth = frame[index(u, v)];
      if (!is_reading(depth)) continue;
      ++n;
      far += depth * rays[index(u, v)].norm() > middle ? 1 : 0;
    }
    side.share = far / n;
    side.unlikeness = side.share * (1 - side.share) * n / (n - 1);
    sides_[index(u, v)] = side;
  }

  int width_, height_;
  const std::vector<PixelScatter>& pixels_;
  double sigma_;
  std::vector<Side> sides_;
};

// The edge through the centre of a window.
struct Edge {
  double unlikeness = 0;     // Σ p (1 - p)
  Eigen::Vector2d gradient;  // Σ of the share's; across the edge, with its length [px]
  double near = 0, far = 0;  // [m]
};

std::optional<Edge> edge_at(const FarShare& share, int u, int v) {
  const auto smooth = [&](int x, int y) {
    double sum = 0;
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) sum += share.at(x + i, y + j).share / 9;
    }
    return sum;
  };
  for (int y = v - kReach - 1; y <= v + kReach + 1; ++y) {
    for (int x = u - kReach - 1; x <= u + kReach + 1; ++x) {
      if (share.at(x, y).share < 0) return {};
    }
  }
  Edge edge{0, Eigen::Vector2d::Zero(), share.at(u, v).near, share.at(u, v).far};
  Eigen::Vector2d smoothed = Eigen::Vector2d::Zero();
  double length = 0;
  for (int y = v - kReach; y <= v + kReach; ++y) {
    for (int x = u - kReach; x <= u + kReach; ++x) {
      edge.unlikeness += share.at(x, y).unlikeness;
      edge.gradient += 0.5 * Eigen::Vector2d(share.at(x + 1, y).share - share.at(x - 1, y).share,
                                             share.at(x, y + 1).share - share.at(x, y - 1).share);
      if (std::max(std::abs(x - u), std::abs(y - v)) == kReach) continue;
      const Eigen::Vector2d slope(0.5 * (smooth(x + 1, y) - smooth(x - 1, y)),
                                  0.5 * (smooth(x, y + 1) - smooth(x, y - 1)));
      smoothed += slope;
      length += slope.norm();
    }
  }
  if (edge.gradient.norm() < kReach || smoothed.norm() < kStraight * length) return {};
  return edge;
}

}  // namespace

std::vector<PixelScatter> scatter_of(const std::vector<std::vector<float>>& depths,
                                     const std::vector<Eigen::Vector3d>& rays) {
  std::vector<PixelScatter> pixels(rays.size());
  std::vector<double> ranges;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ranges.clear();
    for (const std::vector<float>& frame : depths) {
      if (is_reading(frame[i])) ranges.push_back(frame[i] * rays[i].norm());
    }
    if (10 * ranges.size() >= 9 * depths.size()) pixels[i] = scatter_of_pixel(ranges);
  }
  return pixels;
}

EdgeScatter edge_scatter(const PinholeCamera& camera, const std::vector<std::vector<float>>& depths,
                         const std::vector<Eigen::Vector3d>& rays,
                         const std::vector<PixelScatter>& pixels, double sigma) {
  const FarShare share(camera, depths, rays, pixels, sigma);
  std::vector<bool> taken(pixels.size());
  const auto index = [&](int u, int v) { return static_cast<std::size_t>(v * camera.width + u); };
  double unlikeness = 0, per_metre = 0;  // Σ p (1 - p), and the same per metre of σ_lat
  EdgeScatter result;
  constexpr int kRim = kAround + kReach + 2;
  for (int v = kRim; v < camera.height - kRim; ++v) {
    for (int u = kRim; u < camera.width - kRim; ++u) {
      const FarShare::Side& side = share.at(u, v);
      if (taken[index(u, v)] || side.share < 0.3 || side.share > 0.7) continue;
      const std::optional<Edge> edge = edge_at(share, u, v);
      if (!edge) continue;
      for (int y = v - kReach; y <= v + kReach; ++y) {
        for (int x = u - kReach; x <= u + kReach; ++x) taken[index(x, y)] = true;
      }
      const double length = edge->gradient.norm();
      const Eigen::Vector3d& ray = rays[index(u, v)];
      // A lateral shift is longer in the image away from the centre, most in the outward direction.
      const Eigen::Vector2d across =
          edge->gradient.cwiseProduct(Eigen::Vector2d(camera.fx, camera.fy)) / length;
      const double outward = across.dot(ray.head<2>());
      const double shift =
          ray.norm() * std::sqrt(across.squaredNorm() + outward * outward);  // [px rad⁻¹]
      unlikeness += edge->unlikeness;
      result.length += length;
      result.sigma_px += edge->unlikeness * camera.fx / shift;
      per_metre += length * shift * 0.5 * (1 / edge->near + 1 / edge->far);
    }
  }
  if (result.length == 0) return result;
  constexpr double kSqrtPi = 1.0 / std::numbers::inv_sqrtpi;
  result.sigma_px *= kSqrtPi / result.length;
  result.sigma_lateral = kSqrtPi * unlikeness / per_metre;
  return result;
}

}  // namespace viewgain::detail
