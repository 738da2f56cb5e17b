// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/wall_frame.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain::detail {
namespace {

constexpr double kBlocks = 600;         // an image has about as many
constexpr double kBorderShare = 0.02;   // of the shorter side
constexpr double kLeastReadings = 0.5;  // share of a block's pixels
constexpr std::size_t kLeastBlocks = 10;
constexpr double kSigmas = 4;            // that noise may come to
constexpr double kFlat = 0.02;           // a systematic error bends a wall by less [m]
constexpr double kFlatShare = 0.01;      // and of the range
constexpr double kOnPlane = 0.6;         // share of the readings that have to
constexpr double kElsewhere = 0.1;       // no systematic error comes to it [m]
constexpr double kElsewhereShare = 0.1;  // and of the range

// The readings of a block, pixel by pixel.
struct Pixels {
  Eigen::Vector3d mean_ray = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> rays;
  std::vector<double> ranges;  // [m]
};

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::invalid_argument, name + ": " + what);
}

std::string metres(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", value);
  return text;
}

// The blocks with enough readings; the others, and the border, are counted.
std::vector<Pixels> cut(const PinholeCamera& camera, const std::vector<Eigen::Vector3d>& rays,
                        const DepthFrame& image, WallFrame& frame) {
  const int shorter = std::min(camera.width, camera.height);
  const int border = shorter > 2 ? std::max(1, static_cast<int>(kBorderShare * shorter)) : 0;
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const int side = std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / kBlocks))));
  const int columns = (camera.width + side - 1) / side, rows = (camera.height + side - 1) / side;
  std::vector<Pixels> blocks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<int> inside(blocks.size(), 0);  // pixels that might be readings
  std::size_t i = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u, ++i) {
      const double depth = image.depth[i];
      const bool is_reading = depth > 0 && std::isfinite(depth) && rays[i].allFinite();
      if (std::min({u, v, camera.width - 1 - u, camera.height - 1 - v}) < border) {
        frame.border += is_reading ? 1 : 0;
        continue;
      }
      const auto block = static_cast<std::size_t>(v / side * columns + u / side);
      ++inside[block];
      if (!is_reading) continue;
      blocks[block].mean_ray += rays[i];
      blocks[block].rays.push_back(rays[i]);
      blocks[block].ranges.push_back(depth * rays[i].norm());
    }
  }
  std::vector<Pixels> full;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Pixels& block = blocks[b];
    const auto count = static_cast<double>(block.ranges.size());
    if (count == 0 || count < kLeastReadings * inside[b]) {
      frame.sparse += block.ranges.size();
      continue;
    }
    block.mean_ray /= count;
    full.push_back(std::move(block));
  }
  return full;
}

// The plane of which the blocks' median inverse depths are off by the least sum of amounts, each
// told as a range: up to a third of the blocks may show other things.
InversePlane fitted_plane(const std::vector<Pixels>& blocks) {
  constexpr int kTurns = 50;
  constexpr double kLeastResidual = 1e-4;  // [m]
  std::vector<double> inverse_depths, metres_per_unit;
  for (const Pixels& block : blocks) {
    std::vector<double> values;
    for (std::size_t i = 0; i < block.ranges.size(); ++i) {
      values.push_back(block.rays[i].norm() / block.ranges[i]);
    }
    inverse_depths.push_back(median(std::move(values)));
    metres_per_unit.push_back(block.mean_ray.norm() / std::pow(inverse_depths.back(), 2));
  }
  InversePlane plane = InversePlane::Zero();
  std::vector<double> weights(blocks.size(), 1.0);
  for (int turn = 0; turn < kTurns; ++turn) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const Eigen::Vector3d ray = metres_per_unit[b] * blocks[b].mean_ray;
      A += weights[b] * ray * ray.transpose();
      g += weights[b] * metres_per_unit[b] * inverse_depths[b] * ray;
    }
    // A line of pixels does not tell the tilt about itself; then it is 0.
    A.diagonal() += Eigen::Vector3d(1, 1, 0) * (1e-12 * A.trace());
    plane = A.ldlt().solve(g);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const double residual =
          metres_per_unit[b] * (inverse_depths[b] - plane.dot(blocks[b].mean_ray));
      weights[b] = 1 / std::max(std::abs(residual), kLeastResidual);
    }
  }
  return plane;
}

// Along the ray: on a slant a reading beside its place is of another range.
double reading_sigma(const Sensor& sensor, const InversePlane& plane, const Eigen::Vector3d& ray,
                     double range) {
  const double cosine = std::clamp(plane.dot(ray) / (plane.norm() * ray.norm()), 0.0, 1.0);
  const double bounded = std::max(cosine, kMinCosIncidence);
  return sigma_along_normal(sensor.sigmas(range, cosine), bounded) / bounded;
}

void check_flat(const WallFrame& frame, const InversePlane& plane) {
  double on = 0, all = 0, worst = 0;
  for (const WallBlock& block : frame.blocks) {
    const auto readings = static_cast<double>(block.readings);
    const double bound = kFlat + kFlatShare * block.range + kSigmas * block.sigma;
    worst = std::max(worst, bound);
    all += readings;
    if (std::abs(block.range - range_to(plane, block.ray)) < bound) on += readings;
  }
  if (on >= kOnPlane * all) return;
  char share[16];
  std::snprintf(share, sizeof share, "%.0f %%", 100 * on / all);
  refuse(frame.name, "no flat wall: " + std::string(share) + " of its readings lie within " +
                         metres(worst) + " of a plane");
}

void check_place(const WallFrame& frame, const InversePlane& fitted, double distance) {
  std::vector<double> residuals;
  for (const WallBlock& block : frame.blocks) {
    const double said = range_to(frame.plane, block.ray);
    const double bound = kElsewhere + kElsewhereShare * block.range;
    residuals.push_back(said > 0 ? std::abs(block.range - said) / bound : kSigmas);
  }
  if (median(std::move(residuals)) < 1) return;
  if (frame.tilt_is_known) {
    refuse(frame.name,
           "its readings are not of the wall that is said to be there: they cross the "
           "optical axis at " +
               metres(1 / fitted.z()) + ", the wall at " + metres(1 / frame.plane.z()));
  }
  refuse(frame.name, "reads the wall at " + metres(1 / fitted.z()) + " and not at its distance, " +
                         metres(distance));
}

}  // namespace

WallFrame make_wall_frame(const Sensor& sensor, const std::vector<Eigen::Vector3d>& rays,
                          const DepthFrame& image, const std::optional<InversePlane>& wall,
                          double distance, std::string name) {
  WallFrame frame;
  frame.name = std::move(name);
  frame.tilt_is_known = wall.has_value();
  const std::vector<Pixels> blocks = cut(sensor.camera, rays, image, frame);
  if (blocks.size() < kLeastBlocks) refuse(frame.name, "has hardly any readings");
  const InversePlane fitted = fitted_plane(blocks);
  // A wall that is known is where it is; of the other one the readings tell the tilt.
  frame.plane = wall.value_or(fitted / (fitted.z() * distance));

  const double farthest = std::min(sensor.max_range, unambiguous_range(sensor.noise));
  for (const Pixels& pixels : blocks) {
    const double at_ray = range_to(fitted, pixels.mean_ray);
    std::vector<double> residuals;
    for (std::size_t i = 0; i < pixels.ranges.size(); ++i) {
      residuals.push_back(pixels.ranges[i] - range_to(fitted, pixels.rays[i]));
    }
    WallBlock block;
    block.ray = pixels.mean_ray;
    block.range = at_ray + median(std::move(residuals));
    block.readings = pixels.ranges.size();
    const double sigma = reading_sigma(sensor, fitted, block.ray, std::abs(block.range));
    block.sigma = kMedianSigma * sigma / std::sqrt(static_cast<double>(block.readings));
    const bool is_within = block.range - kSigmas * sigma > sensor.min_range &&
                           block.range + kSigmas * sigma < farthest;
    if (!is_within) {
      frame.limits += block.readings;
      continue;
    }
    frame.blocks.push_back(block);
  }
  if (frame.blocks.size() < kLeastBlocks) {
    refuse(frame.name, "has hardly any readings within the sensor's range limits");
  }
  check_flat(frame, fitted);
  check_place(frame, fitted, distance);
  return frame;
}

}  // namespace viewgain::detail
