// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/registration_readings.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "viewgain/core/noise.hpp"

namespace viewgain::detail {
namespace {

constexpr int kMaxHalfWindow = 20;  // [px]
constexpr int kWindow = 25;         // pixels of 5x5
constexpr int kLeastForPlane = 15;
// Smoothed readings may have fewer: those at rims hold poses sideways.
constexpr int kLeastSmoothed = 12;
// A window that lacks readings on one side extrapolates: measured variances grow by the third power
// of how few there are.
constexpr double kRimPower = 3;

class Surroundings {
 public:
  Surroundings(const DepthFrame& frame, const Sensor& sensor, std::span<const Eigen::Vector3d> rays,
               double radius, bool are_smoothed)
      : frame_(frame), sensor_(sensor), rays_(rays), radius_(radius), are_smoothed_(are_smoothed) {}

  [[nodiscard]] bool is_reading(int u, int v) const {
    const std::size_t i = index(u, v);
    const float z = frame_.depth[i];
    if (!(z > 0) || !std::isfinite(z) || !rays_[i].allFinite() || frame_.shows_known(i)) {
      return false;
    }
    const double range = static_cast<double>(z) * rays_[i].norm();
    return range >= sensor_.min_range && range <= sensor_.max_range;
  }

  // Nothing without a normal.
  [[nodiscard]] std::optional<Reading> reading(int u, int v) const {
    if (!is_reading(u, v)) return std::nullopt;
    const std::size_t i = index(u, v);
    const double z = static_cast<double>(frame_.depth[i]);
    const std::optional<Plane> plane = plane_at(u, v, half_window(radius_ / z, sensor_.camera.fx),
                                                half_window(radius_ / z, sensor_.camera.fy));
    if (!plane) return std::nullopt;
    // Of the nearest pixels alone: a wide plane cuts what is curved.
    const std::optional<Plane> near =
        are_smoothed_ ? plane_at(u, v, 2, 2) : Plane{z, plane->normal, kWindow, 0};
    if (!near) return std::nullopt;
    Reading reading;
    reading.point = near->depth * rays_[i];
    reading.normal = plane->normal;
    const double range = reading.point.norm();
    const double frontal = -reading.normal.dot(reading.point) / range;
    const double cosine =
        frame_.amplitude.empty()
            ? frontal
            : std::min(1.0, static_cast<double>(frame_.amplitude[i]) * range * range);
    const MeasurementSigmas sigmas = sensor_.noise_sigmas(range, cosine);
    const double sigma = sigma_along_normal(sigmas, std::abs(frontal));
    reading.variance =
        std::pow(static_cast<double>(kWindow) / near->count, kRimPower) * sigma * sigma;
    reading.axial = sigmas.axial;
    reading.rim = near->beyond * sigmas.lateral;
    reading.u = u, reading.v = v;
    return reading;
  }

 private:
  struct Plane {
    double depth;            // at the pixel, along z [m]
    Eigen::Vector3d normal;  // toward the camera
    int count;               // of readings
    int beyond;              // pixels beside a rim: of farther surface, or without a reading
  };
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame_.width) +
           static_cast<std::size_t>(u);
  }

  // Of what reaches so far in x or y at depth 1.
  static int half_window(double reach, double focal) {
    return std::clamp(static_cast<int>(std::lround(reach * focal)), 2, kMaxHalfWindow);
  }

  // Through 5x5 readings. A plane n·p = 1 is 1/z = n·(x, y, 1) in the image, linear in n; noise is
  // in z alone.
  [[nodiscard]] std::optional<Plane> plane_at(int u, int v, int half_u, int half_v) const {
    const std::size_t center = index(u, v);
    const double z = static_cast<double>(frame_.depth[center]);
    const Eigen::Vector3d& ray = rays_[center];
    // A surface turned by up to 70° reaches that deep.
    const double deepest =
        2.75 * std::max(radius_, 2 * z / sensor_.camera.fx) + 3 * sensor_.noise_sigmas(z).axial;
    Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    int count = 0, beyond = 0;
    for (int a = -2; a <= 2; ++a) {
      const int y = v + a * half_v / 2;
      if (y < 0 || y >= frame_.height) continue;
      for (int b = -2; b <= 2; ++b) {
        const int x = u + b * half_u / 2;
        if (x < 0 || x >= frame_.width) continue;
        const std::size_t i = index(x, y);
        const double depth = static_cast<double>(frame_.depth[i]);
        if (!is_reading(x, y) || depth > z + deepest) {
          ++beyond;
          continue;
        }
        if (depth < z - deepest) continue;
        const Eigen::Vector3d row(rays_[i].x() - ray.x(), rays_[i].y() - ray.y(), 1);
        normal_matrix += row * row.transpose();
        right += row / depth;
        ++count;
      }
    }
    if (count < (are_smoothed_ ? kLeastSmoothed : kLeastForPlane)) return std::nullopt;
    const Eigen::Vector3d plane = normal_matrix.inverse() * right;
    Eigen::Vector3d toward(plane.x(), plane.y(),
                           plane.z() - plane.x() * ray.x() - plane.y() * ray.y());
    toward.normalize();
    // Of a surface that is seen; what has no such plane is a rim.
    if (!toward.allFinite() || !(toward.dot(ray) > 0)) return std::nullopt;
    return Plane{1 / plane.z(), -toward, count, beyond};
  }

  const DepthFrame& frame_;
  const Sensor& sensor_;
  std::span<const Eigen::Vector3d> rays_;
  double radius_;
  bool are_smoothed_;
};

int level_of(int column, int row) {
  if (column % 4 == 0 && row % 4 == 0) return 0;
  return column % 2 == 0 && row % 2 == 0 ? 1 : 2;
}

}  // namespace

FrameReadings readings_of(const DepthFrame& frame, const Sensor& sensor,
                          std::span<const Eigen::Vector3d> rays, double radius, bool are_smoothed,
                          std::size_t max_readings, ThreadPool& pool) {
  const Surroundings surroundings(frame, sensor, rays, radius, are_smoothed);
  const auto height = static_cast<std::size_t>(frame.height);
  std::vector<std::size_t> of_row(height);
  pool.for_each_chunk(height, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      for (int u = 0; u < frame.width; ++u) {
        if (surroundings.is_reading(u, static_cast<int>(v))) ++of_row[v];
      }
    }
  });
  std::size_t count = 0;
  for (const std::size_t n : of_row) count += n;
  const int stride =
      std::max(1, static_cast<int>(std::lround(
                      std::sqrt(static_cast<double>(count) / static_cast<double>(max_readings)))));
  const std::size_t lattice_rows =
      (height + static_cast<std::size_t>(stride) - 1) / static_cast<std::size_t>(stride);
  std::vector<std::vector<Reading>> rows(lattice_rows);
  pool.for_each_chunk(lattice_rows, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int v = static_cast<int>(row) * stride;
      for (int column = 0; column * stride < frame.width; ++column) {
        std::optional<Reading> reading = surroundings.reading(column * stride, v);
        if (!reading) continue;
        reading->level = level_of(column, static_cast<int>(row));
        rows[row].push_back(*reading);
      }
    }
  });
  FrameReadings readings{{}, stride};
  for (const std::vector<Reading>& row : rows) {
    readings.all.insert(readings.all.end(), row.begin(), row.end());
  }
  return readings;
}

}  // namespace viewgain::detail
