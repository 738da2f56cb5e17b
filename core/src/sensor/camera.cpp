// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/camera.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr int kMaxSize = 16384;  // [px]
constexpr int kMaxPixels = 1 << 24;
constexpr double kTolerance = 1e-12;  // of normalised coordinates
// Enough for Newton's method to converge with usual lenses.
constexpr int kFixedPointIterations = 4;
constexpr int kNewtonIterations = 30;
constexpr int kBranchChecks = 16;  // points between the axis and a solution
constexpr int kContinuationSteps = 64;

/// OpenCV's distortion of the normalised point p = (x, y), and its Jacobian.
struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;
};

Distorted distort(const std::array<double, 5>& d, const Eigen::Vector2d& p) {
  const auto [k1, k2, p1, p2, k3] = d;
  const double x = p.x(), y = p.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double d_radial = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);  // by r²
  Distorted out;
  out.point = {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
               y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  const double mixed = 2.0 * x * y * d_radial + 2.0 * p1 * x + 2.0 * p2 * y;
  out.jacobian << radial + 2.0 * x * x * d_radial + 2.0 * p1 * y + 6.0 * p2 * x, mixed, mixed,
      radial + 2.0 * y * y * d_radial + 6.0 * p1 * y + 2.0 * p2 * x;
  return out;
}

/// Newton from `p`; false if it leaves the region where the model keeps orientation or stalls.
bool newton(const std::array<double, 5>& d, const Eigen::Vector2d& target, Eigen::Vector2d& p) {
  for (int i = 0; i < kNewtonIterations; ++i) {
    const Distorted at = distort(d, p);
    const Eigen::Vector2d residual = target - at.point;
    if (!(at.jacobian.determinant() > 0)) return false;
    p += at.jacobian.inverse() * residual;
    // Checked before the step, because the step after a residual this small is the last
    // improvement.
    if (residual.lpNorm<Eigen::Infinity>() < kTolerance) return true;
  }
  return false;
}

/// A folded lens model maps several points to one pixel. The real point is the one that is
/// connected to the optical axis by points before the fold.
bool on_central_branch(const std::array<double, 5>& d, const Eigen::Vector2d& p) {
  for (int i = 1; i <= kBranchChecks; ++i) {
    const Eigen::Vector2d q = p * (static_cast<double>(i) / kBranchChecks);
    if (!(distort(d, q).jacobian.determinant() > 0)) return false;
  }
  return true;
}

Eigen::Vector2d undistort(const std::array<double, 5>& d, const Eigen::Vector2d& target) {
  Eigen::Vector2d p = target;
  for (int i = 0; i < kFixedPointIterations; ++i) p += target - distort(d, p).point;
  if (newton(d, target, p) && on_central_branch(d, p)) return p;

  // With strong distortion, follows the solution outwards from the axis.
  p.setZero();
  for (int i = 1; i <= kContinuationSteps; ++i) {
    if (!newton(d, target * (static_cast<double>(i) / kContinuationSteps), p)) {
      return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (on_central_branch(d, p)) return p;
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

[[noreturn]] void fail(const std::string& what) { refuse("camera: " + what); }

}  // namespace

void PinholeCamera::validate() const {
  const auto check_size = [](const char* name, int value) {
    if (value < 1 || value > kMaxSize) {
      fail(std::string(name) + " must be in 1.." + std::to_string(kMaxSize) + " px, not " +
           std::to_string(value));
    }
  };
  check_size("width", width);
  check_size("height", height);
  if (width * height > kMaxPixels) {
    fail("width x height is " + std::to_string(width) + " x " + std::to_string(height) +
         "; the maximum is 2^24 pixels");
  }
  const auto check_focal = [](const char* name, double value) {
    if (!(std::isfinite(value) && value > 0)) {
      fail(std::string(name) + " must be positive and finite, not " + short_text(value));
    }
  };
  check_focal("fx", fx);
  check_focal("fy", fy);
  if (!std::isfinite(cx)) fail("cx must be finite");
  if (!std::isfinite(cy)) fail("cy must be finite");
  constexpr std::array<const char*, 5> kNames{"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    if (!std::isfinite(distortion[i])) {
      fail(std::string("distortion ") + kNames[i] + " must be finite");
    }
  }
}

Eigen::Vector3d PinholeCamera::ray(double u, double v) const {
  Eigen::Vector2d p((u - cx) / fx, (v - cy) / fy);
  if (has_distortion()) p = undistort(distortion, p);
  return {p.x(), p.y(), 1.0};
}

void PinholeCamera::project(const Eigen::Vector3d& p_camera, double& u, double& v) const {
  if (!(p_camera.z() > 0)) {
    u = v = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  Eigen::Vector2d p(p_camera.x() / p_camera.z(), p_camera.y() / p_camera.z());
  if (has_distortion()) p = distort(distortion, p).point;
  u = fx * p.x() + cx;
  v = fy * p.y() + cy;
}

bool PinholeCamera::sees(const Eigen::Vector3d& p_camera) const {
  constexpr double kSameRay = 1e-6;  // of normalised coordinates
  double u = 0, v = 0;
  project(p_camera, u, v);
  if (!(u >= -0.5 && u < width - 0.5 && v >= -0.5 && v < height - 0.5)) return false;
  return !has_distortion() || (ray(u, v) - p_camera / p_camera.z()).norm() < kSameRay;
}

std::vector<Eigen::Vector3d> PinholeCamera::ray_table() const {
  std::vector<Eigen::Vector3d> table;
  table.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (!has_distortion()) {
    std::vector<double> x;  // of each column
    for (int u = 0; u < width; ++u) x.push_back((u - cx) / fx);
    for (int v = 0; v < height; ++v) {
      const double y = (v - cy) / fy;
      for (const double of_column : x) table.emplace_back(of_column, y, 1.0);
    }
    return table;
  }
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) table.push_back(ray(u, v));
  }
  return table;
}

std::vector<double> PinholeCamera::solid_angles(std::span<const Eigen::Vector3d> rays) const {
  std::vector<double> angles(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (rays.size() != angles.size()) {
    fail("one ray per pixel is required; rays: " + std::to_string(rays.size()) +
         ", pixels: " + std::to_string(angles.size()));
  }
  const auto index = [this](int u, int v) {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(u);
  };
  const auto ray_of = [&](int u, int v) -> const Eigen::Vector3d* {
    if (u < 0 || v < 0 || u >= width || v >= height) return nullptr;
    const Eigen::Vector3d& found = rays[index(u, v)];
    return found.allFinite() ? &found : nullptr;
  };
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const Eigen::Vector3d* own = ray_of(u, v);
      if (own == nullptr) continue;
      const auto slope = [&](int du, int dv, const Eigen::Vector2d& ideal) -> Eigen::Vector2d {
        const Eigen::Vector3d* before = ray_of(u - du, v - dv);
        const Eigen::Vector3d* after = ray_of(u + du, v + dv);
        const double steps = (before != nullptr ? 1 : 0) + (after != nullptr ? 1 : 0);
        if (steps == 0) return ideal;
        return ((after != nullptr ? *after : *own) - (before != nullptr ? *before : *own))
                   .head<2>() /
               steps;
      };
      const Eigen::Vector2d across = slope(1, 0, {1.0 / fx, 0.0});
      const Eigen::Vector2d down = slope(0, 1, {0.0, 1.0 / fy});
      const double cosine = 1.0 / own->norm();
      angles[index(u, v)] =
          cosine * cosine * cosine * std::abs(across.x() * down.y() - across.y() * down.x());
    }
  }
  return angles;
}

}  // namespace viewgain
