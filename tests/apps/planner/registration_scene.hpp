// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "viewgain/core/sensor.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain::test {

inline constexpr double kDegree = std::numbers::pi / 180;

/// A surface over columns and rows of parameters in [0, 1]; each face looks to where the two
/// derivatives' cross product does.
inline TriangleMesh sheet(int columns, int rows,
                          const std::function<Eigen::Vector3d(double, double)>& at) {
  TriangleMesh mesh;
  for (int r = 0; r <= rows; ++r) {
    for (int c = 0; c <= columns; ++c) {
      const Eigen::Vector3d p = at(static_cast<double>(c) / columns, static_cast<double>(r) / rows);
      mesh.vertices.push_back({p.x(), p.y(), p.z()});
    }
  }
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const auto i = static_cast<std::uint32_t>(r * (columns + 1) + c);
      const auto next = static_cast<std::uint32_t>(i + static_cast<std::uint32_t>(columns) + 1);
      mesh.triangles.push_back({i, i + 1, next + 1});
      mesh.triangles.push_back({i, next + 1, next});
    }
  }
  return mesh;
}

/// A sphere with bumps of this height [m]; 0: a sphere.
inline TriangleMesh bumpy_sphere(double radius, double bump) {
  return sheet(360, 180, [=](double s, double t) {
    const double azimuth = 2 * std::numbers::pi * s, polar = std::numbers::pi * (1 - t);
    const Eigen::Vector3d d(std::sin(polar) * std::cos(azimuth),
                            std::sin(polar) * std::sin(azimuth), std::cos(polar));
    const double bumps = std::sin(7 * d.x() + 1) * std::sin(6 * d.y()) +
                         std::sin(5 * d.z() + 2) * std::sin(8 * d.x()) +
                         std::sin(9 * d.y() + 1) * std::sin(7 * d.z());
    return Eigen::Vector3d((radius + bump * bumps) * d);
  });
}

/// Round the z axis, without lids.
inline TriangleMesh cylinder(double radius, double height) {
  return sheet(360, 20, [=](double s, double t) {
    const double azimuth = 2 * std::numbers::pi * s;
    return Eigen::Vector3d(radius * std::cos(azimuth), radius * std::sin(azimuth),
                           height * (t - 0.5));
  });
}

/// A square across the x axis that looks to where x grows.
inline TriangleMesh wall(double edge) {
  return sheet(10, 10, [=](double s, double t) {
    return Eigen::Vector3d(0, edge * (s - 0.5), edge * (t - 0.5));
  });
}

/// Camera at an azimuth and elevation [deg] round the origin.
inline Pose camera_at(double azimuth, double elevation, double distance) {
  const double a = azimuth * kDegree, e = elevation * kDegree;
  return look_at(
      distance * Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)),
      {0, 0, 0});
}

/// The pose, its centre shifted and turned about it, in random directions.
inline Pose disturbed(const Pose& pose, double shift, double turn, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
  };
  const Eigen::Vector3d along = direction();
  const Eigen::Vector3d axis = direction();
  return {Eigen::AngleAxisd(turn, axis).toRotationMatrix() * pose.rotation(),
          pose.translation() + shift * along};
}

struct PoseError {
  double translation;  // [m]
  double rotation;     // [rad]
};
inline PoseError error_of(const Pose& pose, const Pose& truth) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation() * truth.rotation().transpose()));
  return {(pose.translation() - truth.translation()).norm(), std::abs(turn.angle())};
}

/// A map of an object from views at known poses, and the camera that took them.
class RegistrationScene {
 public:
  static constexpr double kVoxel = 0.005;
  static constexpr double kDistance = 0.5;

  RegistrationScene(TriangleMesh mesh, bool noise, const std::vector<Pose>& views,
                    std::uint64_t seed = 1)
      : camera_(std::make_shared<const SurfaceScene>(std::move(mesh), ExecConfig{1}), sensor,
                simulation(noise, seed), ExecConfig{1}),
        grid(layout()) {
    FrameIntegrator integrator(sensor, {}, {1});
    for (std::size_t i = 0; i < views.size(); ++i) {
      integrator.integrate(grid, camera_.acquire(views[i], i), views[i]);
    }
  }

  [[nodiscard]] DepthFrame see(const Pose& pose, std::uint64_t frame = 1000) const {
    return camera_.acquire(pose, frame);
  }

 private:
  static SimulationConfig simulation(bool noise, std::uint64_t seed) {
    SimulationConfig config;
    config.noise = config.lateral_noise = noise;
    config.seed = seed;
    return config;
  }

 public:
  [[nodiscard]] GridConfig layout() const {
    GridConfig config;
    config.voxel_size = kVoxel;
    config.workspace = {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
    return config;
  }
  [[nodiscard]] FrameAlignment alignment(int threads = 1) const {
    ScorerConfig map;
    map.jump_edges.reset();  // the camera makes no flying pixels
    map.voxel_size = layout().voxel_size;
    map.workspace = layout().workspace;
    return FrameAlignment(sensor, map, {threads});
  }

  Sensor sensor = sensor_preset("sr4000");

 private:
  SimulatedSensor camera_;

 public:
  BeliefGrid grid;
};

/// Views side by side round what a frame from azimuth 0 sees.
inline std::vector<Pose> views_round() {
  return {camera_at(-25, 10, RegistrationScene::kDistance),
          camera_at(20, -10, RegistrationScene::kDistance),
          camera_at(5, 30, RegistrationScene::kDistance)};
}

/// The covariance of a result.
inline Eigen::Matrix<double, 6, 6> covariance_of(const FrameRegistration& result) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6>>(result.covariance.data());
}

inline Eigen::Matrix<double, 6, 1> difference(const Pose& pose, const Pose& from) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.rotation() * from.rotation().transpose()));
  Eigen::Matrix<double, 6, 1> d;
  d << pose.translation() - from.translation(), turn.angle() * turn.axis();
  return d;
}

}  // namespace viewgain::test
