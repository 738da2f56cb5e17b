// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/noise_calibration.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "calibration/pixel_scatter.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using detail::PixelScatter;

constexpr double kMayMove = 0.003;         // fraction of pixels
constexpr double kLeastEdge = 100;         // [px]
constexpr std::size_t kLeastSmooth = 500;  // pixels
constexpr int kFromJump = 6;               // [px]
constexpr double kLeastCos = 0.866;        // of incidence
constexpr double kStep = 1.05;             // ratio of ranges in one step
constexpr double kShapeSpan = 1.3;         // least ratio of ranges that shows how σ_ax grows
constexpr int kTurns = 20;

[[noreturn]] void fail(const std::string& what) { refuse("noise cannot be measured: " + what); }

std::string percent(double share) { return short_text(std::round(1000 * share) / 10) + " %"; }

// A pixel on a smooth surface.
struct SmoothPixel {
  double range;  // [m]
  double cosine;
  double variance;  // along the ray [m²]
};

// Marks pixels without a depth jump or a missing reading nearby.
std::vector<bool> smooth_places(const PinholeCamera& camera,
                                const std::vector<PixelScatter>& pixels, double sigma) {
  const int width = camera.width, height = camera.height;
  const auto index = [&](int u, int v) { return static_cast<std::size_t>(v * width + u); };
  std::vector<bool> smooth(pixels.size(), false), jumps(pixels.size(), true);
  for (int v = 1; v < height - 1; ++v) {
    for (int u = 1; u < width - 1; ++u) {
      double near = pixels[index(u, v)].median, far = near;
      for (const auto& [x, y] : {std::pair{u - 1, v}, {u + 1, v}, {u, v - 1}, {u, v + 1}}) {
        near = std::min(near, pixels[index(x, y)].median);
        far = std::max(far, pixels[index(x, y)].median);
      }
      jumps[index(u, v)] = near == 0 || far - near > std::max(3 * sigma, 0.02 * near);
    }
  }
  for (int v = kFromJump; v < height - kFromJump; ++v) {
    for (int u = kFromJump; u < width - kFromJump; ++u) {
      bool is_smooth = true;
      for (int y = v - kFromJump + 1; y < v + kFromJump && is_smooth; ++y) {
        for (int x = u - kFromJump + 1; x < u + kFromJump && is_smooth; ++x) {
          is_smooth = !jumps[index(x, y)];
        }
      }
      smooth[index(u, v)] = is_smooth;
    }
  }
  return smooth;
}

// From the plane through the surrounding 5x5 pixels.
double cos_incidence(const std::vector<Eigen::Vector3d>& rays,
                     const std::vector<PixelScatter>& pixels, std::size_t i, std::size_t width) {
  Eigen::Vector3d along_u = Eigen::Vector3d::Zero(), along_v = along_u;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      const std::size_t k = i + static_cast<std::size_t>(y + 2) * width +
                            static_cast<std::size_t>(x + 2) - 2 * width - 2;
      const Eigen::Vector3d point = rays[k] * (pixels[k].mean / rays[k].norm());
      along_u += x * point;
      along_v += y * point;
    }
  }
  const Eigen::Vector3d normal = along_u.cross(along_v).normalized();
  return std::abs(normal.dot(rays[i].normalized()));
}

std::vector<SmoothPixel> smooth_pixels(const PinholeCamera& camera,
                                       const std::vector<Eigen::Vector3d>& rays,
                                       const std::vector<PixelScatter>& pixels, double sigma,
                                       double unit) {
  const std::vector<bool> smooth = smooth_places(camera, pixels, sigma);
  std::vector<SmoothPixel> result;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!smooth[i]) continue;
    const double cosine = cos_incidence(rays, pixels, i, static_cast<std::size_t>(camera.width));
    if (!(cosine > kLeastCos)) continue;
    const double rounding = unit * unit / 12 * rays[i].squaredNorm();
    result.push_back({pixels[i].mean, cosine, std::max(0.0, pixels[i].variance - rounding)});
  }
  std::sort(result.begin(), result.end(),
            [](const SmoothPixel& a, const SmoothPixel& b) { return a.range < b.range; });
  return result;
}

// σ_ax of each range step. The model provides the ratio between angles, and the lateral noise on
// slanted surfaces (times `lateral`), which is subtracted. Uses the median because it is robust,
// divided by that of χ² with n - 1 degrees of freedom.
std::vector<NoiseStep> steps_of(const std::vector<SmoothPixel>& pixels, const Sensor& sensor,
                                std::size_t frames, double lateral) {
  const double chi_median = std::pow(1 - 2 / (9 * static_cast<double>(frames - 1)), 3);
  std::vector<NoiseStep> steps;
  for (std::size_t i = 0; i < pixels.size();) {
    NoiseStep step;
    std::vector<double> ratios;
    double axial = 0, beside = 0;  // sums of variances [m²]
    const double end = pixels[i].range * kStep;
    for (; i < pixels.size() && pixels[i].range < end; ++i) {
      const SmoothPixel& pixel = pixels[i];
      const MeasurementSigmas sigma = sensor.noise_sigmas(pixel.range, pixel.cosine);
      const double tangent2 = 1 / (pixel.cosine * pixel.cosine) - 1;
      const double own = sigma.axial * sigma.axial,
                   slant = std::pow(lateral * sigma.lateral, 2) * tangent2;
      ratios.push_back(pixel.variance / (own + slant));
      axial += own;
      beside += slant;
      step.range += pixel.range;
    }
    step.pixels = ratios.size();
    if (step.pixels < 30) continue;
    step.range /= static_cast<double>(step.pixels);
    const double all = detail::median(std::move(ratios)) / chi_median * (axial + beside);
    step.fitted_axial = sensor.noise_sigmas(step.range).axial;
    step.sigma_axial = step.fitted_axial * std::sqrt(std::max(0.0, all - beside) / axial);
    steps.push_back(step);
  }
  return steps;
}

bool tells_shape(const std::vector<NoiseStep>& steps) {
  return steps.size() >= 4 && steps.back().range > kShapeSpan * steps.front().range;
}

// Measured σ_ax divided by the model's, averaged over pixels.
double factor_of(const std::vector<NoiseStep>& steps) {
  double sum = 0, weights = 0;
  for (const NoiseStep& step : steps) {
    sum += static_cast<double>(step.pixels) * step.sigma_axial / step.fitted_axial;
    weights += static_cast<double>(step.pixels);
  }
  return sum / weights;
}

// Fits offset + quadratic (t - vertex)² with non-negative coefficients.
void fit_growth(const std::vector<NoiseStep>& steps, double vertex, double& offset,
                double& quadratic) {
  const double factor = factor_of(steps);
  if (!tells_shape(steps)) {
    offset *= factor;
    quadratic *= factor;
    return;
  }
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  for (const NoiseStep& step : steps) {
    const Eigen::Vector2d basis(1, std::pow(step.range - vertex, 2));
    const double weight = static_cast<double>(step.pixels) / std::pow(step.fitted_axial, 2);
    A += weight * basis * basis.transpose();
    g += weight * step.sigma_axial * basis;
  }
  Eigen::Vector2d x = A.inverse() * g;
  if (!(x[0] > 0)) x = {0, g[1] / A(1, 1)};
  if (!(x[1] > 0)) x = {g[0] / A(0, 0), 0};
  offset = x[0];
  quadratic = x[1];
}

// Fits the model to the measured axial noise.
struct AxialFit {
  const std::vector<NoiseStep>& steps;

  void operator()(ShotNoise& noise) const { noise.reference_sigma *= factor_of(steps); }
  void operator()(StereoNoise& noise) const { noise.subpixel *= factor_of(steps); }
  void operator()(ConstantNoise& noise) const { noise.sigma_axial *= factor_of(steps); }
  void operator()(QuadraticNoise& noise) const {
    noise.linear *= tells_shape(steps) ? 0 : factor_of(steps);
    fit_growth(steps, 0, noise.offset, noise.quadratic);
  }
  void operator()(StructuredLightNoise& noise) const {
    fit_growth(steps, noise.vertex, noise.offset, noise.quadratic);
  }
};

bool has_shape(const NoiseModel& noise) {
  return std::holds_alternative<QuadraticNoise>(noise) ||
         std::holds_alternative<StructuredLightNoise>(noise);
}

bool set_lateral(NoiseModel& noise, const detail::EdgeScatter& edges) {
  if (auto* light = std::get_if<StructuredLightNoise>(&noise)) {
    light->lateral_px = edges.sigma_px;
  } else if (auto* constant = std::get_if<ConstantNoise>(&noise)) {
    constant->sigma_lateral = edges.sigma_lateral;
  } else {
    return false;
  }
  return true;
}

}  // namespace

NoiseCalibration::NoiseCalibration(const Sensor& sensor, double unit)
    : sensor_(sensor), unit_(unit) {
  sensor_.validate();
}

void NoiseCalibration::add(const DepthFrame& frame) {
  const PinholeCamera& camera = sensor_.camera;
  if (frame.width != camera.width || frame.height != camera.height ||
      frame.depth.size() != camera.ray_table().size()) {
    fail("a frame and its sensor have different image sizes");
  }
  depths_.push_back(frame.depth);
}

NoiseCalibrationResult NoiseCalibration::solve() const {
  if (depths_.size() < kLeastFrames) {
    fail(std::to_string(kLeastFrames) + " frames from one pose are required, not " +
         std::to_string(depths_.size()));
  }
  const std::vector<Eigen::Vector3d> rays = sensor_.camera.ray_table();
  const std::vector<PixelScatter> pixels = detail::scatter_of(depths_, rays);
  std::vector<double> variances;
  std::size_t moving = 0;
  for (const PixelScatter& pixel : pixels) {
    if (pixel.median == 0) continue;
    variances.push_back(pixel.variance);
    moving += pixel.moves ? 1 : 0;
  }
  if (variances.size() < kLeastSmooth) fail("too few pixels have a depth in 90 % of the frames");
  NoiseCalibrationResult result;
  const double readings = static_cast<double>(variances.size());
  const double sigma = std::sqrt(detail::median(std::move(variances)));
  result.moving_share = static_cast<double>(moving) / readings;
  if (result.moving_share > kMayMove) {
    fail("the depths of " + percent(result.moving_share) +
         " of the pixels change with time. Does the scene or the camera move?");
  }
  if (!(sigma * sigma > unit_ * unit_ / 12)) {
    fail("the noise of the depths is below their rounding step of " + short_text(unit_) +
         " m. Are the depths filtered?");
  }
  const auto smooth = smooth_pixels(sensor_.camera, rays, pixels, sigma, unit_);
  if (smooth.size() < kLeastSmooth) {
    fail("only " + std::to_string(smooth.size()) +
         " pixels see a smooth surface at an angle of less than 30 degrees; " +
         std::to_string(kLeastSmooth) + " are required");
  }
  const auto edges = detail::edge_scatter(sensor_.camera, depths_, rays, pixels, sigma);
  if (edges.length < kLeastEdge) {
    fail("the straight depth edges in the images are " + short_text(std::round(edges.length)) +
         " px long in total, but " + short_text(kLeastEdge) +
         " px are required. Put a box in front of a wall");
  }

  result.sensor = sensor_;
  result.sigma_lateral_px = edges.sigma_px;
  result.edge_length = edges.length;
  result.lateral_in_model = set_lateral(result.sensor.noise, edges);
  // Iterates, because the lateral noise on slanted surfaces depends on the fit. A model with a
  // fixed σ_lat of 1 px is scaled to the measured one.
  const double lateral = result.lateral_in_model ? 1 : edges.sigma_px;
  for (int turn = 0; turn < kTurns; ++turn) {
    result.steps = steps_of(smooth, result.sensor, depths_.size(), lateral);
    if (result.steps.empty() || factor_of(result.steps) < 1e-3) {
      fail(
          "depths of smooth surfaces have almost no noise along the ray. Are the depths filtered?");
    }
    std::visit(AxialFit{result.steps}, result.sensor.noise);
  }
  result.ranges_tell_shape = has_shape(sensor_.noise) && tells_shape(result.steps);
  for (NoiseStep& step : result.steps) {
    step.fitted_axial = result.sensor.noise_sigmas(step.range).axial;
  }
  result.sensor.validate();
  return result;
}

}  // namespace viewgain
