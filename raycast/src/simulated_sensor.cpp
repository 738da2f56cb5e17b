// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/simulated_sensor.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain {
namespace {

// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): a good hash of a counter, so that each pixel has
// noise of its own whatever the order in which pixels are made.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

// A standard normal number for (seed, frame, pixel), by Box and Muller.
double normal(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel) {
  const std::uint64_t a = mix(mix(mix(seed) ^ frame) ^ pixel);
  const std::uint64_t b = mix(a);
  const double u = (static_cast<double>(a >> 11U) + 0.5) * 0x1.0p-53;
  const double v = static_cast<double>(b >> 11U) * 0x1.0p-53;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

// Where a ray from inside the sphere of radius r round the origin leaves it; outside: infinity,
// then the room is not there.
double sphere_exit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double r) {
  const double b = origin.dot(direction);
  const double c = origin.squaredNorm() - r * r;
  if (c > 0) return std::numeric_limits<double>::infinity();
  return -b + std::sqrt(b * b - c);
}

}  // namespace

struct SimulatedSensor::Impl {
  std::shared_ptr<const SurfaceScene> scene;
  Sensor sensor;
  SimulationConfig config;
  std::vector<Eigen::Vector3d> rays;  // (x, y, 1), camera frame
  mutable ThreadPool pool;

  Impl(std::shared_ptr<const SurfaceScene> s, const Sensor& se, const SimulationConfig& c,
       int threads)
      : scene(std::move(s)), sensor(se), config(c), rays(se.camera.ray_table()), pool(threads) {}

  [[nodiscard]] float pixel(const Eigen::Matrix3d& R_world_camera, const Eigen::Vector3d& p_world,
                            std::size_t index, std::uint64_t frame_index) const {
    const Eigen::Vector3d& ray = rays[index];
    if (!ray.allFinite()) return DepthFrame::kInvalid;
    const double length = ray.norm();
    const Eigen::Vector3d direction = R_world_camera * (ray / length);
    const SurfaceHit hit = scene->intersect(p_world, direction);
    double range = hit.range;
    double cos_incidence = std::abs(hit.normal.dot(direction));
    if (config.background_radius > 0) {
      const double wall = sphere_exit(p_world, direction, config.background_radius);
      if (wall < range) {
        range = wall;
        cos_incidence =
            std::abs((p_world + wall * direction).dot(direction)) / config.background_radius;
      }
    }
    if (range < sensor.min_range) return DepthFrame::kInvalid;
    if (range > sensor.max_range) return DepthFrame::kOutOfRange;
    if (config.noise) {
      range += sensor.sigmas(range, cos_incidence).axial * normal(config.seed, frame_index, index);
      if (range < sensor.min_range) return DepthFrame::kInvalid;
      if (range > sensor.max_range) return DepthFrame::kOutOfRange;
    }
    return static_cast<float>(range / length);
  }
};

SimulatedSensor::SimulatedSensor(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
                                 const SimulationConfig& config, const ExecConfig& exec) {
  if (!scene) throw Error(ErrorCode::invalid_argument, "the simulated sensor has no scene");
  sensor.validate();
  if (!(config.background_radius >= 0) || !std::isfinite(config.background_radius)) {
    throw Error(ErrorCode::invalid_argument,
                "background radius " + std::to_string(config.background_radius) + " m is not >= 0");
  }
  impl_ = std::make_unique<Impl>(std::move(scene), sensor, config, exec.num_threads);
}

SimulatedSensor::~SimulatedSensor() = default;
SimulatedSensor::SimulatedSensor(SimulatedSensor&&) noexcept = default;
SimulatedSensor& SimulatedSensor::operator=(SimulatedSensor&&) noexcept = default;

DepthFrame SimulatedSensor::acquire(const Pose& T_world_camera, std::uint64_t frame_index) const {
  if (!(orthonormality_error(T_world_camera) <= 1e-3)) {
    throw Error(ErrorCode::invalid_argument,
                "the simulated sensor's pose is not a rigid transform");
  }
  const Pose pose = orthonormalized(T_world_camera);
  const Eigen::Matrix3d R_world_camera = pose.rotation();
  const Eigen::Vector3d p_world = pose.translation();
  const PinholeCamera& camera = impl_->sensor.camera;
  DepthFrame frame{camera.width, camera.height, std::vector<float>(impl_->rays.size())};
  impl_->pool.for_each_chunk(frame.depth.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      frame.depth[i] = impl_->pixel(R_world_camera, p_world, i, frame_index);
    }
  });
  return frame;
}

}  // namespace viewgain
