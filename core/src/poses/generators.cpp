// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/generators.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::size_t kMaxPoses = 100'000'000;  // 9.6 GB

void check(const char* what, std::size_t count, double radius, const Eigen::Vector3d& center) {
  const std::string name(what);
  if (count == 0) refuse(name + ": the number of poses must be at least 1, not 0");
  if (count > kMaxPoses) {
    throw Error(ErrorCode::capacity, name + ": " + std::to_string(count) +
                                         " poses are too many; the maximum is " +
                                         std::to_string(kMaxPoses));
  }
  if (!(std::isfinite(radius) && radius > 0)) {
    refuse(name + ": the radius must be positive and finite, not " + short_text(radius));
  }
  if (!center.allFinite()) refuse(name + ": the centre must be finite");
}

/// `count` lattice points whose z_i run from 1 downwards in steps of 2 / steps.
std::vector<Pose> lattice(std::size_t count, double steps, double radius,
                          const Eigen::Vector3d& center) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Pose> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double index = static_cast<double>(i);
    const double z = 1.0 - (2.0 * index + 1.0) / steps;
    const double ring = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double azimuth = index * golden_angle;
    const Eigen::Vector3d offset(ring * std::cos(azimuth), ring * std::sin(azimuth), z);
    poses.push_back(look_at(center + radius * offset, center));
  }
  return poses;
}

void check_finite(const char* what, const char* name, double value) {
  if (std::isfinite(value)) return;
  refuse(std::string(what) + ": the " + name + " must be finite");
}

/// Adds the poses of one ring; its numbers are checked.
void append_ring(std::size_t count, double radius, double height, double tilt, double start,
                 const Eigen::Vector3d& center, std::vector<Pose>& poses) {
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth =
        start + 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const Eigen::Vector3d outward(std::cos(azimuth), std::sin(azimuth), 0.0);
    const Eigen::Vector3d eye = center + radius * outward + Eigen::Vector3d(0, 0, height);
    const Eigen::Vector3d direction =
        -std::cos(tilt) * outward - Eigen::Vector3d(0, 0, std::sin(tilt));
    // Computed at the origin, so that a distant eye does not round the direction.
    poses.emplace_back(look_at(Eigen::Vector3d::Zero(), direction).rotation(), eye);
  }
}

/// Rings on a cylinder at `heights`. Above the highest, rings at `elevations` on a sphere of the
/// same radius. Each ring is repeated with each of `tilts` added to its direction.
struct RingPattern {
  std::vector<double> heights;     // [m]
  std::vector<double> elevations;  // [rad]
  std::vector<double> tilts;       // [rad]
};

void append_pattern(const RingPattern& pattern, double radius, double scale,
                    const Eigen::Vector3d& center, std::vector<Pose>& poses) {
  constexpr std::size_t kAzimuths = 16;
  const auto append = [&](double ring_radius, double height, double tilt) {
    for (const double more : pattern.tilts) {
      append_ring(kAzimuths, scale * ring_radius, scale * height, tilt + more, 0.0, center, poses);
    }
  };
  for (const double height : pattern.heights) append(radius, height, 0.0);
  for (const double elevation : pattern.elevations) {
    append(radius * std::cos(elevation), pattern.heights.back() + radius * std::sin(elevation),
           elevation);
  }
}

/// Replaces <random>, whose distributions differ between standard libraries.
class PortableRandom {
 public:
  explicit PortableRandom(std::uint64_t seed) : seed_(seed) {}

  /// Uniform in [0, 1).
  double unit() { return unit_number(mix64(counter_++ * kMixStep + seed_)); }

  /// Uniform on the unit sphere (Marsaglia 1972), without sine and cosine, whose last bits depend
  /// on the mathematical library.
  Eigen::Vector3d direction() {
    for (;;) {
      const double a = 2.0 * unit() - 1.0, b = 2.0 * unit() - 1.0;
      const double s = a * a + b * b;
      if (s >= 1.0) continue;
      const double ring = 2.0 * std::sqrt(1.0 - s);
      return {a * ring, b * ring, 1.0 - 2.0 * s};
    }
  }

 private:
  std::uint64_t seed_;
  std::uint64_t counter_ = 0;
};

}  // namespace

std::vector<Pose> sphere_poses(std::size_t count, double radius, const Eigen::Vector3d& center) {
  check("sphere", count, radius, center);
  return lattice(count, static_cast<double>(count), radius, center);
}

std::vector<Pose> dome_poses(std::size_t count, double radius, const Eigen::Vector3d& center) {
  check("dome", count, radius, center);
  return lattice(count, 2.0 * static_cast<double>(count), radius, center);
}

std::vector<Pose> orbit_poses(std::size_t count, double radius, double elevation, double start,
                              std::optional<double> step, const Eigen::Vector3d& center) {
  check("orbit", count, radius, center);
  const double turn = step.value_or(2.0 * std::numbers::pi / static_cast<double>(count));
  if (!std::isfinite(elevation) || !std::isfinite(start) || !std::isfinite(turn)) {
    refuse("orbit: the angles must be finite");
  }
  std::vector<Pose> poses;
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth = start + static_cast<double>(i) * turn;
    const Eigen::Vector3d offset(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    poses.push_back(look_at(center + radius * offset, center));
  }
  return poses;
}

std::vector<Pose> ring_poses(std::size_t count, double radius, double height, double tilt,
                             double start, const Eigen::Vector3d& center) {
  check("rings", count, radius, center);
  check_finite("rings", "height", height);
  check_finite("rings", "tilt", tilt);
  check_finite("rings", "start angle", start);
  std::vector<Pose> poses;
  poses.reserve(count);
  append_ring(count, radius, height, tilt, start, center, poses);
  return poses;
}

std::vector<Pose> literature_ring_poses(std::size_t total, double radius,
                                        const Eigen::Vector3d& center) {
  constexpr double kDegree = std::numbers::pi / 180;
  const RingPattern of_48{{0.15, 0.35}, {45 * kDegree}, {0.0}};
  const RingPattern of_80{{0.15, 0.30, 0.45}, {30 * kDegree, 60 * kDegree}, {0.0}};
  const RingPattern of_288{
      {0.1, 0.2, 0.3, 0.4}, {30 * kDegree, 60 * kDegree}, {0.0, -22.5 * kDegree, 22.5 * kDegree}};
  check("rings", total, radius, center);
  std::vector<Pose> poses;
  switch (total) {
    case 48:
      append_pattern(of_48, 0.6, radius / 0.6, center, poses);
      break;
    case 80:
      append_pattern(of_80, 0.5, radius / 0.5, center, poses);
      break;
    case 288:
      append_pattern(of_288, 0.5, radius / 0.5, center, poses);
      break;
    case 864:
      for (const double r : {0.4, 0.6, 0.8}) append_pattern(of_288, r, radius / 0.5, center, poses);
      break;
    default:
      refuse("rings: the number of poses must be 48, 80, 288 or 864, not " + std::to_string(total));
  }
  return poses;
}

std::vector<Pose> shell_poses(std::size_t count, double min_radius, double max_radius,
                              std::uint64_t seed, const Eigen::Vector3d& center) {
  check("shell", count, min_radius, center);
  check("shell", count, max_radius, center);
  if (min_radius > max_radius) {
    refuse("shell: the minimum radius, " + short_text(min_radius) +
           ", exceeds the maximum radius, " + short_text(max_radius));
  }
  PortableRandom random(seed);
  std::vector<Pose> poses;
  poses.reserve(count);
  while (poses.size() < count) {
    // Keeping a uniform radius with probability (r / max)² gives a uniform density in the volume.
    const double radius = min_radius + (max_radius - min_radius) * random.unit();
    const double ratio = radius / max_radius;
    if (random.unit() >= ratio * ratio) continue;
    poses.push_back(look_at(center + radius * random.direction(), center));
  }
  return poses;
}

}  // namespace viewgain
