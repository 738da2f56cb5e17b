// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Where pixels meet known obstacles, against slabs in double precision.
#include "viewgain/raycast/obstacle_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/expect_error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Sensor small() {
  Sensor sensor = sensor_preset("sr4000");
  PinholeCamera& c = sensor.camera;
  c.width = 44, c.height = 36, c.fx = c.fy = 40, c.cx = 21.2, c.cy = 17.7;
  c.distortion = {-0.2, 0.05, 0.001, -0.002, 0};
  return sensor;
}

struct Entry {
  double range = kInfinity, cosine = 0;
};

// Where a ray enters a box, or leaves it from within; infinity: nowhere.
Entry entry(const Box& box, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  Entry in{-kInfinity, 0}, out;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto k = static_cast<Eigen::Index>(a);
    const double t0 = (box.min[a] - o[k]) / d[k], t1 = (box.max[a] - o[k]) / d[k];
    if (std::min(t0, t1) > in.range) in = {std::min(t0, t1), std::abs(d[k])};
    if (std::max(t0, t1) < out.range) out = {std::max(t0, t1), std::abs(d[k])};
  }
  if (in.range > out.range || out.range <= 0) return {};
  return in.range > 0 ? in : out;
}

TEST(ObstacleView, DepthsAreThoseOfTheFirstObstacle) {
  const Sensor sensor = small();
  Obstacles obstacles;
  obstacles.boxes = {{{-0.2, -0.1, 0}, {-0.15, 0.12, 0.2}}, {{0.1, -0.3, -0.1}, {0.4, 0.02, 0.15}}};
  obstacles.meshes = {mesh_of(Obstacles{{{{-0.05, 0.1, 0}, {0.05, 0.2, 0.3}}}, {}})};
  std::vector<Box> boxes = obstacles.boxes;
  boxes.push_back({{-0.05, 0.1, 0}, {0.05, 0.2, 0.3}});
  const ObstacleView view(obstacles, sensor, {2});
  const std::vector<Eigen::Vector3d> rays = sensor.camera.ray_table();
  std::vector<Pose> poses = sphere_poses(20, 0.8, {0.01, 0.02, 0.03});
  poses.push_back(look_at({0.25, -0.1, 0.05}, {0.25, -0.1, 0.05 + 1}, {0, 1, 0}));  // inside of one
  std::size_t pixels = 0, met = 0, at_edges = 0;
  for (const Pose& pose : poses) {
    DepthFrame frame{sensor.camera.width, sensor.camera.height,
                     std::vector<float>(rays.size(), 1.0F)};
    view.mark(frame, pose);
    ASSERT_EQ(frame.known_depth.size(), rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i, ++pixels) {
      const Eigen::Vector3d d = (pose.rotation() * rays[i]).normalized();
      Entry first;
      for (const Box& box : boxes) {
        const Entry one = entry(box, pose.translation(), d);
        if (one.range < first.range) first = one;
      }
      // Three sigmas before it.
      double expected = kInfinity;
      if (std::isfinite(first.range)) {
        const MeasurementSigmas s = sensor.sigmas(first.range, first.cosine);
        const double c = std::max(first.cosine, kMinCosIncidence);
        const double sine = std::sqrt(1 - first.cosine * first.cosine);
        const double before = 3 * std::hypot(s.axial * first.cosine, s.lateral * sine) / c;
        expected = std::max(0.0, first.range - before) / rays[i].norm();
      }
      const double found = static_cast<double>(frame.known_depth[i]);
      const bool same = expected == found || std::abs(found - expected) < 5e-6;
      at_edges += same ? 0 : 1;  // where single precision passes an edge on the other side
      met += std::isfinite(expected) ? 1 : 0;
    }
  }
  EXPECT_EQ(pixels, 21U * 44 * 36);
  EXPECT_GT(met, pixels / 10);
  EXPECT_LT(at_edges, pixels / 5000);
}

// Neither how far off the origin is nor a rotation that is a little off makes a difference.
TEST(ObstacleView, WhereTheOriginIsDoesNotMatter) {
  const Sensor sensor = small();
  const auto depths = [&](const Eigen::Vector3d& o, const Pose& pose) {
    const Box box{{o.x() - 0.2, o.y() - 0.1, o.z()}, {o.x() - 0.1, o.y() + 0.2, o.z() + 0.2}};
    DepthFrame frame{44, 36, std::vector<float>(44 * 36, 1.0F)};
    ObstacleView({{box}, {}}, sensor).mark(frame, {pose.rotation(), pose.translation() + o});
    return frame.known_depth;
  };
  const Pose pose = look_at({0.5, 0.4, 0.4}, {0, 0, 0.1});
  const std::vector<float> here = depths({0, 0, 0}, pose);
  const std::vector<float> there = depths({500'000, 4'500'000, 400}, pose);
  std::size_t met = 0, at_edges = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    met += std::isfinite(here[i]) ? 1U : 0U;
    at_edges += here[i] != there[i] && !(std::abs(here[i] - there[i]) < 1e-5F) ? 1U : 0U;
  }
  EXPECT_GT(met, 60U);
  EXPECT_LE(at_edges, 2U);
  Pose off = pose;
  for (const std::size_t k : {0U, 4U, 8U}) off.m[k] *= 1 + 4e-4;
  EXPECT_EQ(depths({0, 0, 0}, off), depths({0, 0, 0}, orthonormalized(off)));
}

// Embree, as Debian builds it, aborts for a ray that is none.
TEST(ObstacleView, WhatCannotBeTracedMeetsNothing) {
  const Sensor sensor = small();
  const Box box{{-0.1, -0.1, 0.9}, {0.1, 0.1, 1.1}};
  DepthFrame frame{44, 36, std::vector<float>(44 * 36, 1.0F)};
  const ObstacleView view({{box}, {}}, sensor);
  for (const double far : {1e17, 1e19, 1e154, 1e300}) {
    view.mark(frame, Pose(Eigen::Matrix3d::Identity(), {0, -far, 0}));
    for (const float depth : frame.known_depth) ASSERT_TRUE(std::isinf(depth)) << far;
  }

  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const SurfaceScene scene(mesh_of({{box}, {}}));
  const SurfaceScene::Ray good{{0, 0, 0}, {0, 0, 1}};
  std::vector<SurfaceScene::Ray> rays{good};
  for (const double wrong : {kNan, kInfinity, -kInfinity, 1e19}) {
    rays.insert(rays.end(), {{{0, wrong, 0}, {0, 0, 1}}, good, {{0, 0, 0}, {wrong, 0, 1}}});
  }
  rays.insert(rays.end(), {{{0, 0, 0}, {0, 0, 1}, kNan}, good});
  std::vector<SurfaceScene::Hit> hits(rays.size());
  scene.intersect(rays, hits);
  std::array<bool, 15> blocked{};
  ASSERT_EQ(rays.size(), blocked.size());
  scene.block(rays, blocked);
  std::size_t met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(std::isfinite(hits[i].range), blocked[i]) << i;
    met += blocked[i] ? 1 : 0;
  }
  EXPECT_EQ(met, 6U);  // the good ones
}

TEST(ObstacleView, WithoutObstaclesNothingIsKnown) {
  const Sensor sensor = small();
  DepthFrame frame{44, 36, std::vector<float>(44 * 36, 1.0F)};
  frame.known_depth.assign(44 * 36, 0.5F);
  ObstacleView({}, sensor).mark(frame, {});
  EXPECT_TRUE(frame.known_depth.empty());
}

TEST(ObstacleView, RefusesWhatIsWrong) {
  const Sensor sensor = small();
  Obstacles wrong;
  wrong.boxes = {{{0, 0, 0}, {1, -1, 1}}};
  test::expect_error(ErrorCode::invalid_argument, "inside out",
                     [&] { const ObstacleView never(wrong, sensor); });
  wrong.boxes.clear();
  wrong.meshes = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}, {{{0, 0, 1}}, {}}};
  test::expect_error(ErrorCode::invalid_argument, "vertex 3, but the mesh has 3 vertices",
                     [&] { const ObstacleView never(wrong, sensor); });
  const ObstacleView view({}, sensor);
  DepthFrame small_frame{2, 2, std::vector<float>(4)};
  test::expect_error(ErrorCode::invalid_argument, "2 x 2", [&] { view.mark(small_frame, {}); });
  DepthFrame frame{44, 36, std::vector<float>(44 * 36)};
  Pose nan;
  nan.m[0] = std::numeric_limits<double>::quiet_NaN();
  test::expect_error(ErrorCode::invalid_argument, "rigid", [&] { view.mark(frame, nan); });
}

TEST(ObstacleView, ASimulatedCameraSeesItsSurroundings) {
  const Sensor sensor = small();
  const Obstacles wall{{{{-0.5, -0.5, 0.2}, {0.5, 0.5, 0.25}}}, {}};
  const auto object = std::make_shared<const SurfaceScene>(
      mesh_of(Obstacles{{{{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}}, {}}));
  const Pose above = look_at({0, 0, 0.8}, {0, 0, 0}, {0, 1, 0});
  SimulationConfig config;
  const DepthFrame without = SimulatedSensor(object, sensor, config).acquire(above);
  config.surroundings = std::make_shared<const SurfaceScene>(mesh_of(wall));
  DepthFrame with = SimulatedSensor(object, sensor, config).acquire(above);
  ObstacleView(wall, sensor).mark(with, above);
  std::size_t hidden = 0;
  for (std::size_t i = 0; i < with.depth.size(); ++i) {
    if (std::isinf(with.known_depth[i])) {
      EXPECT_EQ(with.depth[i], without.depth[i]);
      continue;
    }
    EXPECT_TRUE(with.shows_known(i));
    hidden += std::isfinite(without.depth[i]) ? 1 : 0;
  }
  EXPECT_GT(hidden, 50U);
}

}  // namespace
}  // namespace viewgain
