// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "registration/map_view.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "viewgain/grid/fused_points.hpp"

namespace viewgain::detail {
namespace {

// Columns of radius 1 round points 0.75 to 1 apart: each reading of the map is in about three.
constexpr double kPointsPerReading = 3;
constexpr double kPoseSigmas = 5;  // by which the pose may be off
constexpr double kBehind = 10;     // pooling lengths behind what the frame shows
constexpr double kCube = 10;       // pooling lengths

// How deep a frame may look, wherever its pose may be [m].
class SeenDepths {
 public:
  SeenDepths(const RegistrationView& frame, const Sensor& sensor, const PoseSigma& sigma,
             double nearest)
      : camera_(frame.camera) {
    const double shift = kPoseSigmas * sigma.translation, turn = kPoseSigmas * sigma.rotation;
    tile_ = static_cast<int>(
        std::clamp((shift / nearest + turn) * camera_.fx, 8.0, std::max(8.0, camera_.width / 2.0)));
    columns_ = camera_.width / tile_ + 3;  // one beside the image, on each side
    deepest_.assign(static_cast<std::size_t>(columns_ * (camera_.height / tile_ + 3)), 0.0);
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      const auto z = static_cast<double>(frame.depth[i]);
      if (!(z > 0) || !std::isfinite(z)) continue;
      const int pixel = static_cast<int>(i);
      double& deepest = deepest_[tile_of(pixel % camera_.width, pixel / camera_.width)];
      deepest = std::max(deepest, z + shift + 2 * turn * z + 4 * sensor.noise_sigmas(z).axial);
    }
  }

  // Round a pixel of the image.
  [[nodiscard]] double round(const Eigen::Vector2d& pixel) const {
    const std::size_t tile =
        tile_of(static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5));
    double deepest = 0;
    for (const int row : {-columns_, 0, columns_}) {
      const auto middle = deepest_.begin() + static_cast<std::ptrdiff_t>(tile) + row;
      deepest = std::max({deepest, middle[-1], middle[0], middle[1]});
    }
    return deepest;
  }

 private:
  [[nodiscard]] std::size_t tile_of(int u, int v) const {
    return static_cast<std::size_t>((v / tile_ + 1) * columns_ + u / tile_ + 1);
  }

  const PinholeCamera& camera_;
  int tile_, columns_;           // [px], with those beside the image
  std::vector<double> deepest_;  // tile by tile
};

// The number of the cube that a point lies in.
class Cubes {
 public:
  explicit Cubes(double edge) : edge_(edge) {}
  std::uint32_t of(const Eigen::Vector3d& point) {
    const Eigen::Array3d cube = (point / edge_).array().floor();
    const auto next = static_cast<std::uint32_t>(numbers_.size());
    return numbers_.try_emplace({cube.x(), cube.y(), cube.z()}, next).first->second;
  }
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }

 private:
  double edge_;
  std::map<std::array<double, 3>, std::uint32_t> numbers_;
};

// Each node of the lattice has the nearest of the points that fall on it.
void draw(RegistrationView& view) {
  view.clear_lattice();
  for (std::size_t i = 0; i < view.readings.size(); ++i) {
    const Eigen::Vector3d& point = view.readings[i].point;
    const Eigen::Vector2d node = view.camera.project(point) / view.stride;
    const int column = static_cast<int>(node.x() + 0.5), row = static_cast<int>(node.y() + 0.5);
    if (column >= view.columns() || row >= view.rows()) continue;
    std::int32_t& at = view.at[view.node(column, row)];
    if (at < 0 || point.z() < view.readings[static_cast<std::size_t>(at)].point.z()) {
      at = static_cast<std::int32_t>(i);
    }
  }
}

}  // namespace

RegistrationView map_view(const BeliefGrid& grid, double length, const Sensor& sensor,
                          const RegistrationView& frame, const Pose& T_reported,
                          const PoseSigma& sigma, const ExecConfig& exec) {
  RegistrationView view{frame.camera, {}, 1, {}, {}, &grid, T_reported};
  view.clear_lattice();
  if (frame.readings.empty()) return view;
  double range = 0, nearest = frame.readings.front().point.z();
  for (const Reading& reading : frame.readings) {
    range += reading.point.norm() / static_cast<double>(frame.readings.size());
    nearest = std::min(nearest, reading.point.z());
  }
  const SeenDepths seen(frame, sensor, sigma, nearest);
  const Pose T_camera_world = T_reported.inverse();
  const PinholeCamera& camera = frame.camera;
  FusedPointsConfig config;
  config.where = [&](const Eigen::Vector3d& p_world) {
    const Eigen::Vector3d p = T_camera_world * p_world;
    return camera.sees(p) && p.z() <= seen.round(camera.project(p)) + kBehind * length;
  };
  Cubes cubes(kCube * length);
  const Eigen::Matrix3d R_camera_world = T_camera_world.rotation();
  for (const FusedPoint& fused : fused_points(grid, config, exec)) {
    const Eigen::Vector3d point(fused.position.data()), normal(fused.toward_free.data());
    Reading reading;
    reading.point = T_camera_world * point;
    reading.normal = R_camera_world * normal;
    // Seen from inside, or beside the picture.
    if (!(reading.normal.dot(reading.point) < 0) || !camera.sees(reading.point)) continue;
    const double variance = normal.dot(fused.covariance * normal);
    reading.axial = std::sqrt(variance);
    reading.variance = kPointsPerReading * variance;
    reading.part = cubes.of(point);
    view.readings.push_back(reading);
  }
  view.parts = cubes.size();
  view.stride = std::max(1, static_cast<int>(std::lround(length * camera.fx / range)));
  draw(view);
  // The error of a point is shared by all readings that belong to it.
  const auto drawn = std::count_if(view.at.begin(), view.at.end(), [](auto i) { return i >= 0; });
  const double share = static_cast<double>(frame.readings.size()) /
                       static_cast<double>(std::max<std::ptrdiff_t>(drawn, 1));
  for (Reading& reading : view.readings) reading.variance *= std::max(1.0, share);
  return view;
}

}  // namespace viewgain::detail
