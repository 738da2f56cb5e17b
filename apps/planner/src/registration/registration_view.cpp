// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/registration_view.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "viewgain/core/noise.hpp"

namespace viewgain::detail {
namespace {

constexpr int kMaxHalfWindow = 20;  // [px]
constexpr int kWindow = 25;         // pixels of 5x5
constexpr int kLeastForPlane = 15;
// Minimum for smoothed readings: those at rims determine lateral motion.
constexpr int kLeastSmoothed = 12;
// A window that lacks readings on one side extrapolates: measured variances grow with the third
// power of 25 over their number.
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

  // Empty without a normal.
  [[nodiscard]] std::optional<Reading> reading(int u, int v) const {
    if (!is_reading(u, v)) return std::nullopt;
    const std::size_t i = index(u, v);
    const double z = static_cast<double>(frame_.depth[i]);
    const std::optional<Plane> plane = plane_at(u, v, half_window(radius_ / z, sensor_.camera.fx),
                                                half_window(radius_ / z, sensor_.camera.fy));
    if (!plane) return std::nullopt;
    // From the nearest pixels only: a wide plane cuts off curved surface.
    const std::optional<Plane> near =
        are_smoothed_ ? plane_at(u, v, 2, 2) : Plane{z, plane->normal, kWindow, 0};
    if (!near) return std::nullopt;
    Reading reading;
    reading.point = near->depth * rays_[i];
    reading.normal = plane->normal;
    const double range = reading.point.norm();
    const double frontal = -reading.normal.dot(reading.point) / range;
    const double cosine =
        frame_.amplitude.empty() || frame_.amplitude[i] == DepthFrame::kSaturated
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
    Eigen::Vector3d normal;  // towards the camera
    int count;               // of readings
    int beyond;              // pixels past a rim: of farther surface, or without a reading
  };
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame_.width) +
           static_cast<std::size_t>(u);
  }

  // Sum over a window of this extent in x or y at depth 1.
  static int half_window(double reach, double focal) {
    return std::clamp(static_cast<int>(std::lround(reach * focal)), 2, kMaxHalfWindow);
  }

  // Plane through 5x5 readings. A plane n·p = 1 is 1/z = n·(x, y, 1) in the image, linear in n;
  // only z has noise.
  [[nodiscard]] std::optional<Plane> plane_at(int u, int v, int half_u, int half_v) const {
    const std::size_t center = index(u, v);
    const double z = static_cast<double>(frame_.depth[center]);
    const Eigen::Vector3d& ray = rays_[center];
    // A surface turned by up to 70° has this depth range.
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
    // For visible surface; readings without such a plane are rims.
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

// Largest distance of a pair in sigmas, and the distance from which pairs lose weight: 95 %
// efficient for Gaussian errors.
constexpr double kGateSigmas = 4;
constexpr double kCauchy = 2.385;
constexpr double kMinCosine = 0.6216;  // limit between the normals of a pair: 0.9 rad

bool is_free(const RegistrationView& map, const Eigen::Vector3d& point) {
  const auto voxel = map.grid->index_of(map.T_world_view * point);
  return voxel && map.grid->state(*voxel) == VoxelState::free;
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

void RegistrationView::clear_lattice() {
  at.assign(static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()), -1);
}

std::int32_t RegistrationView::reading_at(double u, double v) const {
  const double column = std::floor(u / stride + 0.5), row = std::floor(v / stride + 0.5);
  if (!(column >= 0 && row >= 0 && column < columns() && row < rows())) return -1;
  return at[node(static_cast<int>(column), static_cast<int>(row))];
}

bool RegistrationView::looks_past(const Eigen::Vector3d& point, double margin, double reach) const {
  if (!(point.z() > 0)) return false;
  if (grid != nullptr) {
    const Eigen::Vector3d along = margin * point.normalized();
    return is_free(*this, point) && is_free(*this, point - along) && is_free(*this, point + along);
  }
  const Eigen::Vector2d pixel = camera.project(point);
  const double round = std::max(1.0, std::floor(reach * camera.fx / point.z()));
  const Eigen::Vector2d size(camera.width, camera.height);
  if (!((pixel.array() >= round).all() && (pixel.array() + round < size.array() - 1).all())) {
    return false;
  }
  const auto depth_at = [&](int u, int v) {
    return depth[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
                 static_cast<std::size_t>(u)];
  };
  const int u = static_cast<int>(pixel.x() + 0.5), v = static_cast<int>(pixel.y() + 0.5);
  const int half = static_cast<int>(round);
  for (int y = v - half; y <= v + half; ++y) {
    for (int x = u - half; x <= u + half; ++x) {
      const float z = depth_at(x, y);
      if (z != DepthFrame::kInvalid && static_cast<double>(z) < point.z() + margin) return false;
    }
  }
  return depth_at(u, v) != DepthFrame::kInvalid;
}

RegistrationView view_of(const DepthFrame& frame, const PinholeCamera& camera,
                         FrameReadings readings) {
  RegistrationView view{camera, std::move(readings.all), readings.stride, {}, frame.depth};
  view.clear_lattice();
  for (std::size_t i = 0; i < view.readings.size(); ++i) {
    const Reading& r = view.readings[i];
    view.at[view.node(r.u / view.stride, r.v / view.stride)] = static_cast<std::int32_t>(i);
  }
  return view;
}

namespace {

/// A reading that projects onto one of the target, in the target's axes.
struct Pair {
  const Reading* on = nullptr;  ///< null: no target
  Eigen::Vector3d arm;          ///< vector to it from the source's camera
  Eigen::Vector3d source_normal, normal;
  double e = 0, square = 0;  ///< distance along the normal [m], and in sigmas, squared
};

class PairFinder {
 public:
  PairFinder(const PosedView& source, const PosedView& target, double along, double rim_width)
      : source_(source), target_(target), along_(along), rim_width_(rim_width) {}

  [[nodiscard]] Pair pair_of(const Reading& s) const {
    Pair pair;
    pair.arm = R_ * (s.point - rim_width_ * s.rim * s.normal);
    const Eigen::Vector3d p = pair.arm + t_;
    if (!(p.z() > 0)) return pair;
    double u = 0, v = 0;
    target_.view.camera.project(p, u, v);
    pair.source_normal = R_ * s.normal;
    const bool of_map = target_.view.grid != nullptr;
    const double own_slack = source_.slack_variance(s.point.norm());
    double nearest = std::numeric_limits<double>::infinity();
    // Points of a map lie anywhere in their nodes.
    for (int k = of_map ? 0 : 4; k < (of_map ? 9 : 5); ++k) {
      const int stride = target_.view.stride;
      const std::int32_t at =
          target_.view.reading_at(u + stride * (k % 3 - 1), v + stride * (k / 3 - 1));
      if (at < 0) continue;
      const Reading& m = target_.view.readings[static_cast<std::size_t>(at)];
      if (pair.source_normal.dot(m.normal) < kMinCosine) continue;
      const Eigen::Vector3d d = p - (m.point - rim_width_ * m.rim * m.normal);
      const double distance = d.squaredNorm();
      if (distance >= nearest) continue;
      // Along the mean of both normals: the noise of a single one has more effect, and on curved
      // surface a point beside the other lies outside its plane. Its rotation with the frames is
      // left out of J, as usual, because d is short. A map's normals come from so many readings
      // that they are better alone.
      const Eigen::Vector3d n = of_map ? m.normal : (pair.source_normal + m.normal).normalized();
      const double off = n.dot(d);
      const double slack = own_slack + target_.slack_variance(m.point.norm());
      const double squared = off * off / (s.variance + m.variance + slack);
      if (squared > kGateSigmas * kGateSigmas) continue;
      if (distance - off * off > along_ * along_ + slack) continue;
      pair.on = &m, pair.normal = n, pair.e = off, pair.square = squared, nearest = distance;
    }
    return pair;
  }

 private:
  const PosedView& source_;
  const PosedView& target_;
  double along_, rim_width_;
  Pose T_target_source_ = target_.T_world_view.inverse() * source_.T_world_view;
  Eigen::Matrix3d R_ = T_target_source_.rotation();
  Eigen::Vector3d t_ = T_target_source_.translation();
};

}  // namespace

PairSums pair_sums(const PosedView& source, const PosedView& target, double along, double rim_width,
                   int level, ThreadPool& pool, std::vector<std::uint8_t>* is_paired) {
  const std::vector<Reading>& readings = source.view.readings;
  const PairFinder finder(source, target, along, rim_width);
  std::vector<Pair> pairs(readings.size());
  pool.for_each_chunk(readings.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (readings[i].level <= level) pairs[i] = finder.pair_of(readings[i]);
    }
  });
  PairSums sums;  // the target's axes
  sums.of_parts.assign(target.view.parts, Vector6::Zero());
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (pairs[i].on == nullptr) continue;
    const auto& [on, arm, source_normal, normal, e, square] = pairs[i];
    const Reading& s = readings[i];
    const Reading& m = *on;
    const double weight = 1 / (1 + square / (kCauchy * kCauchy)) / (s.variance + m.variance);
    const auto derivative_along = [&arm = arm](const Eigen::Vector3d& n) {
      Vector6 derivative;
      derivative.head<3>() = n;
      derivative.tail<3>() = arm.cross(n);
      return derivative;
    };
    const Vector6 derivative = derivative_along(normal);
    const Vector6 weighted = weight * derivative;
    sums.information += weighted * derivative.transpose();
    // Their noise is independent.
    sums.agreed +=
        weight * derivative_along(m.normal) * derivative_along(source_normal).transpose();
    sums.gradient += e * weighted;
    if (!sums.of_parts.empty()) sums.of_parts[m.part] += e * weighted;
    const double by_width = m.rim * normal.dot(m.normal) - s.rim * normal.dot(source_normal);
    sums.rim_motion += by_width * weighted;
    sums.rim_information += weight * by_width * by_width;
    sums.rim_gradient += weight * by_width * e;
    sums.squares += e * e;
    ++sums.pairs;
    if (is_paired != nullptr) (*is_paired)[i] = 1;
  }
  Matrix6 to_world = Matrix6::Zero();
  to_world.topLeftCorner<3, 3>() = target.T_world_view.rotation();
  to_world.bottomRightCorner<3, 3>() = target.T_world_view.rotation();
  sums.information = (to_world * sums.information * to_world.transpose()).eval();
  sums.agreed =
      (0.5 * to_world * (sums.agreed + sums.agreed.transpose()) * to_world.transpose()).eval();
  sums.gradient = (to_world * sums.gradient).eval();
  sums.rim_motion = (to_world * sums.rim_motion).eval();
  for (Vector6& part : sums.of_parts) part = (to_world * part).eval();
  return sums;
}

}  // namespace viewgain::detail
