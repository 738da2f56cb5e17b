// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "calibration/range_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/pixel_scatter.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr double kMostSaturated = 0.05;  // fraction of pixels
constexpr double kLeastFlat = 0.6;       // fraction of pixels
constexpr double kMostRough = 0.02;      // fraction of the depth
constexpr double kLeastCosine = 0.7;     // of incidence, at a frame's centre
constexpr std::size_t kReadings = 8000;  // per frame, about
constexpr double kMostTurn = 10;         // between a frame's plane and the wall [deg]
constexpr double kMostOffsetSigma = 0.0005, kMostBend = 0.002, kMostFrameError = 0.004;  // [m]
constexpr int kIterations = 10;
constexpr double kSmoothness = 0.01;

[[noreturn]] void fail_range(const std::string& what) {
  refuse("ranges cannot be calibrated: " + what);
}

std::string millimetres(double metres) { return short_text(std::round(1e4 * metres) / 10) + " mm"; }

}  // namespace

RangeFit::RangeFit(const Sensor& sensor) : sensor_(sensor) {
  sensor.validate();
  sensor_.range_calibration = {};
  rays_ = sensor.camera.ray_table();
}

void RangeFit::add(const DepthFrame& frame, const Pose& T_world_camera, const std::string& name) {
  if (frame.depth.size() != rays_.size())
    refuse(name + ": the image and the sensor have different sizes");
  const auto saturated =
      std::count(frame.amplitude.begin(), frame.amplitude.end(), DepthFrame::kSaturated);
  if (static_cast<double>(saturated) > kMostSaturated * static_cast<double>(rays_.size())) {
    left_out_.push_back(name + ": " + std::to_string(saturated) + " pixels are saturated");
    return;
  }
  // Fits the wall's plane in the camera frame, where 1/z is linear in the ray. Omits outliers.
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const float z = frame.depth[i];
    if (std::isfinite(z) && z > 0 && rays_[i].allFinite()) pixels.push_back(i);
  }
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  double typical = 0;  // median deviation, as a fraction of the depth
  std::vector<std::size_t> wall = pixels;
  for (int i = 0; i < kIterations && wall.size() >= 100; ++i) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const std::size_t k : wall) {
      A += rays_[k] * rays_[k].transpose();
      b += rays_[k] / static_cast<double>(frame.depth[k]);
    }
    plane = A.ldlt().solve(b);
    std::vector<double> off;
    for (const std::size_t k : pixels) {
      off.push_back(std::abs(plane.dot(rays_[k]) * static_cast<double>(frame.depth[k]) - 1));
    }
    typical = detail::median(off);
    const double most = std::max(0.005, 6 * typical);
    wall.clear();
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      if (off[k] < most) wall.push_back(pixels[k]);
    }
  }
  if (wall.size() < 100 || typical > kMostRough ||
      static_cast<double>(wall.size()) < kLeastFlat * static_cast<double>(rays_.size())) {
    left_out_.push_back(name + ": no flat wall fills most of the image");
    return;
  }
  const double cosine = plane.z() / plane.norm();
  if (cosine < kLeastCosine) {
    left_out_.push_back(name + ": the wall is seen at an angle of " +
                        short_text(std::round(std::acos(cosine) * 180 / std::numbers::pi)) +
                        " deg; the maximum is 45 deg");
    return;
  }
  const Eigen::Matrix3d R = T_world_camera.rotation();
  Frame kept{name, T_world_camera.translation(), 0, {}, R * plane.normalized(), 0};
  kept.plane_offset = 1 / plane.norm() + kept.normal_world.dot(kept.center);
  for (std::size_t i = 0; i < wall.size(); i += std::max<std::size_t>(wall.size() / kReadings, 1)) {
    const Eigen::Vector3d& ray = rays_[wall[i]];
    const double range = static_cast<double>(frame.depth[wall[i]]) * ray.norm();
    kept.readings.push_back({R * ray.normalized(), range});
    kept.distance += range;
  }
  kept.distance /= static_cast<double>(kept.readings.size());
  frames_.push_back(std::move(kept));
}

// The wall and the table of errors, which are fitted together. The table uses the true range,
// because noise of the measured range would bias the fit (regression dilution).
struct RangeFit::Wall {
  Eigen::Vector3d normal;      // world
  double offset = 0;           // normal · p [m]
  double first = 0, step = 1;  // of the table's ranges [m]
  Eigen::VectorXd errors;      // [m]

  // Index in the table and weight of the next entry.
  [[nodiscard]] std::pair<Eigen::Index, double> place(double true_range) const {
    const double at =
        std::clamp((true_range - first) / step, 0.0, double(errors.size() - 1) - 1e-9);
    return {static_cast<Eigen::Index>(at), at - std::floor(at)};
  }
  [[nodiscard]] double error(double true_range) const {
    const auto [k, share] = place(true_range);
    return (1 - share) * errors[k] + share * errors[k + 1];
  }
  [[nodiscard]] double true_range(const Eigen::Vector3d& center, const Eigen::Vector3d& ray) const {
    return (offset - normal.dot(center)) / normal.dot(ray);
  }
};

RangeFitResult RangeFit::solve() const {
  std::string named;
  for (const std::string& text : left_out_) named += "; " + text;
  RangeFitResult result{.sensor = sensor_, .left_out = left_out_};
  std::vector<double> distances, ranges;
  for (const Frame& frame : frames_) {
    distances.push_back(frame.distance);
    for (const Reading& reading : frame.readings) ranges.push_back(reading.range);
  }
  std::sort(distances.begin(), distances.end());
  double last = 0;
  for (const double distance : distances) {
    if (distance < 1.02 * last) continue;
    ++result.distances;
    last = distance;
  }
  if (result.distances < kLeastDistances) {
    fail_range("frames from at least " + std::to_string(kLeastDistances) +
               " different distances are required, not " + std::to_string(result.distances) +
               " (distances within 2 % count as one)" + named);
  }
  Wall wall;
  wall.normal = Eigen::Vector3d::Zero();
  std::vector<double> offsets;
  for (const Frame& frame : frames_) wall.normal += frame.normal_world;
  wall.normal.normalize();
  for (const Frame& frame : frames_) {
    const double turn = std::acos(std::min(1.0, wall.normal.dot(frame.normal_world)));
    if (turn * 180 / std::numbers::pi > kMostTurn) {
      fail_range(frame.name +
                 " shows a different wall than the other frames, or its pose is wrong");
    }
    offsets.push_back(frame.plane_offset);
  }
  wall.offset = detail::median(offsets);
  const auto [least, most] = std::minmax_element(ranges.begin(), ranges.end());
  const auto knots = static_cast<Eigen::Index>(std::clamp((*most - *least) / 0.03, 16.0, 60.0));
  wall.first = *least;
  wall.step = (*most - *least) / static_cast<double>(knots - 1);
  wall.errors = Eigen::VectorXd::Zero(knots);

  // Gauss-Newton. Unknowns: the table, two rotations of the normal, and the offset.
  const Eigen::Index size = knots + 3;
  Eigen::MatrixXd A;
  double squares = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    A = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
    const Eigen::Vector3d side = wall.normal.unitOrthogonal(), up = wall.normal.cross(side);
    squares = 0;
    for (const Frame& frame : frames_) {
      for (const auto& [ray, range] : frame.readings) {
        const double true_range = wall.true_range(frame.center, ray);
        const Eigen::Vector3d point = frame.center + true_range * ray;
        const double cosine = wall.normal.dot(ray);
        const auto [k, share] = wall.place(true_range);
        const double residual = range - true_range - wall.error(true_range);
        const double slope = 1 + (wall.errors[k + 1] - wall.errors[k]) / wall.step;
        // Derivatives of the model (true range plus error) by the unknowns.
        const std::array<std::pair<Eigen::Index, double>, 5> parts{
            {{k, 1 - share},
             {k + 1, share},
             {knots, -slope * side.dot(point) / cosine},
             {knots + 1, -slope * up.dot(point) / cosine},
             {knots + 2, slope / cosine}}};
        for (const auto& [i, x] : parts) {
          b[i] += x * residual;
          for (const auto& [j, y] : parts) A(i, j) += x * y;
        }
        squares += residual * residual;
      }
    }
    const double weight =
        kSmoothness * static_cast<double>(ranges.size()) / static_cast<double>(knots);
    for (Eigen::Index k = 1; k + 1 < knots; ++k) {
      Eigen::VectorXd bend = Eigen::VectorXd::Zero(size);
      bend[k - 1] = bend[k + 1] = 1, bend[k] = -2;
      A += weight * bend * bend.transpose();
      b -= weight * bend * bend.head(knots).dot(wall.errors);
    }
    const Eigen::VectorXd change = A.ldlt().solve(b);
    if (!change.allFinite())
      fail_range(
          "the frames do not determine the position of the wall; take frames from more directions");
    wall.errors += change.head(knots);
    wall.normal = (wall.normal + change[knots] * side + change[knots + 1] * up).normalized();
    wall.offset += change[knots + 2];
  }

  // Residuals by frame, and by position on the wall: a bent wall leaves quadratic terms.
  const Eigen::Vector3d side = wall.normal.unitOrthogonal(), up = wall.normal.cross(side);
  Eigen::Matrix<double, 6, 6> B = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> c = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::VectorXd before = Eigen::VectorXd::Zero(std::ssize(frames_)), after = before;
  double extent = 0;
  Eigen::Index at = 0;
  for (const Frame& frame : frames_) {
    const auto count = static_cast<double>(frame.readings.size());
    for (const auto& [ray, range] : frame.readings) {
      const double true_range = wall.true_range(frame.center, ray);
      const Eigen::Vector3d point = frame.center + true_range * ray;
      const double left = range - true_range - wall.error(true_range);
      before[at] += (range - true_range) / count;
      after[at] += left / count;
      const double x = side.dot(point), y = up.dot(point);
      const Eigen::Matrix<double, 6, 1> terms{1, x, y, x * x, x * y, y * y};
      B += terms * terms.transpose();
      c += terms * left * wall.normal.dot(ray);
      extent = std::max(extent, std::pow(side.dot(point - frame.center), 2));
    }
    result.steps.push_back({frame.distance, before[at], after[at], frame.readings.size()});
    ++at;
  }
  const Eigen::Matrix<double, 6, 1> bend = B.ldlt().solve(c);
  const double sag = extent * bend.tail<3>().cwiseAbs().maxCoeff();
  if (sag > kMostBend) fail_range("the wall is not flat; it is bent by about " + millimetres(sag));
  Eigen::Index worst = 0;
  if (after.cwiseAbs().maxCoeff(&worst) > kMostFrameError) {
    fail_range(frames_[static_cast<std::size_t>(worst)].name + " is " + millimetres(after[worst]) +
               " away from the wall of the other frames. Is its pose wrong? Did the wall move?");
  }
  Eigen::VectorXd all = Eigen::VectorXd::Zero(size);
  all.head(knots).setConstant(1.0 / static_cast<double>(knots));
  const double variance = squares / static_cast<double>(ranges.size());
  result.offset_sigma = std::sqrt(variance * std::max(0.0, all.dot(A.ldlt().solve(all))));
  if (!(result.offset_sigma < kMostOffsetSigma)) {
    fail_range("the constant part of the range error is uncertain by " +
               millimetres(result.offset_sigma) +
               ". Turn the camera by 10 to 30 deg at more distances, or take more frames");
  }
  std::sort(result.steps.begin(), result.steps.end(),
            [](const RangeStep& a, const RangeStep& b2) { return a.range < b2.range; });
  const double root = std::sqrt(static_cast<double>(frames_.size()));
  result.rms_before = before.norm() / root, result.rms_after = after.norm() / root;
  for (Eigen::Index k = 0; k < knots; ++k) {
    result.sensor.range_calibration.table.push_back(
        {wall.first + wall.step * static_cast<double>(k) + wall.errors[k], wall.errors[k]});
  }
  result.sensor.validate();
  return result;
}

}  // namespace viewgain
