// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/raycast/simulated_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/expect_error.hpp"
#include "raycast/scene_makers.hpp"
#include "support/meshes.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {
namespace {

std::shared_ptr<const SurfaceScene> plane_at(double z) {
  return std::make_shared<const SurfaceScene>(test::square_mesh(5.0, z));
}

/// Something out of sight, for scenes that are all background.
std::shared_ptr<const SurfaceScene> far_away() { return plane_at(100.0); }

Sensor sensor_without_distortion() { return sensor_preset("sr4000"); }

/// Range along the ray of the pixel [m].
double range_of(const Sensor& sensor, const DepthFrame& frame, int u, int v) {
  return static_cast<double>(frame.at(u, v)) * sensor.camera.ray(u, v).norm();
}

TEST(SimulatedSensor, ScaleErrorsAreThoseOfEveryReading) {
  const Sensor sensor = sensor_without_distortion();
  int cases = 0;
  for (const double error : {-0.02, 0.004}) {
    for (const bool noise : {false, true}) {
      SimulationConfig config{.noise = noise, .lateral_noise = noise};
      const DepthFrame exact = SimulatedSensor(plane_at(0.75), sensor, config).acquire(Pose{});
      config.scale_error = error;
      const DepthFrame off = SimulatedSensor(plane_at(0.75), sensor, config).acquire(Pose{});
      for (std::size_t i = 0; i < exact.depth.size(); ++i, ++cases) {
        EXPECT_NEAR(off.depth[i], (1 + error) * static_cast<double>(exact.depth[i]), 1e-6);
      }
    }
  }
  EXPECT_EQ(cases, 4 * 176 * 144);
  for (const double bad : {-1.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    test::expect_error(ErrorCode::invalid_argument, "scale error",
                       [&] { SimulatedSensor(plane_at(0.75), sensor, {.scale_error = bad}); });
  }
}

// Embree's packets are as wide as an instruction set has them, and each width rounds in its own
// way.
TEST(SimulatedSensor, InstructionSetsDifferInTheLastDigits) {
  const auto ball = test::sphere_mesh(0.1, 64);
  const Sensor sensor = sensor_without_distortion();
  std::vector<DepthFrame> frames;
  for (const std::string& isa : available_isas()) {
    const test::ScopedIsa scoped(isa);
    const SimulatedSensor simulated(std::make_shared<const SurfaceScene>(ball), sensor,
                                    {.background_radius = 1.5});
    frames.push_back(simulated.acquire(look_at({0.6, 0, 0}, {0, 0, 0})));
    std::size_t far = 0;
    for (std::size_t i = 0; i < frames.front().depth.size(); ++i) {
      const double depth = double{frames.front().depth[i]};
      far += std::abs(double{frames.back().depth[i]} - depth) > 1e-5 * depth ? 1 : 0;
    }
    EXPECT_LE(far, 3U) << isa;  // a ray that just meets the ball's edge, or just not
  }
  EXPECT_EQ(frames.size(), available_isas().size());
}

// How sure poses are is nothing that the camera knows.
TEST(SimulatedSensor, NoiseIsTheCamerasAlone) {
  Sensor sensor = sensor_without_distortion();
  const SimulationConfig config{.noise = true, .lateral_noise = true};
  const DepthFrame frame = SimulatedSensor(plane_at(0.75), sensor, config).acquire(Pose{});
  sensor.pose_sigma = {0.02, 0.02};
  EXPECT_EQ(SimulatedSensor(plane_at(0.75), sensor, config).acquire(Pose{}), frame);
}

TEST(SimulatedSensor, SurfaceHidesBackgroundOnlyWhereItIsNearer) {
  const Sensor sensor = sensor_without_distortion();
  const auto ball = std::make_shared<const SurfaceScene>(test::sphere_mesh(0.1, 64));
  const SimulatedSensor simulated(ball, sensor, {.background_radius = 1.5});
  const Pose pose = look_at({0.6, 0, 0}, {0, 0, 0});
  const DepthFrame frame = simulated.acquire(pose);
  int on_ball = 0;
  int cases = 0;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const Eigen::Vector3d d = pose.rotation() * sensor.camera.ray(u, v).normalized();
      const double b = pose.translation().dot(d);
      const double miss = std::sqrt(pose.translation().squaredNorm() - b * b);
      if (std::abs(miss - 0.1) < 0.001) continue;  // the facets' outline
      const double inner = miss < 0.1 ? -b - std::sqrt(0.01 - miss * miss) : 0;
      const double outer = -b + std::sqrt(2.25 - miss * miss);
      EXPECT_NEAR(range_of(sensor, frame, u, v), miss < 0.1 ? inner : outer, 0.003);
      on_ball += miss < 0.1 ? 1 : 0;
      ++cases;
    }
  }
  EXPECT_GT(on_ball, 3000);
  EXPECT_GT(cases, 24'000);
}

TEST(SimulatedSensor, NothingHitOrTooFarIsOutOfRangeAndTooNearIsInvalid) {
  Sensor sensor = sensor_without_distortion();
  const DepthFrame nothing = SimulatedSensor(plane_at(-1), sensor).acquire(Pose{});
  for (const float z : nothing.depth) EXPECT_EQ(z, DepthFrame::kOutOfRange);
  // The limit is along the ray: the plane's corners are beyond it, its middle is not.
  sensor.max_range = 0.76;
  const DepthFrame part = SimulatedSensor(plane_at(0.75), sensor).acquire(Pose{});
  EXPECT_NEAR(part.at(88, 72), 0.75, 1e-5);
  EXPECT_EQ(part.at(0, 0), DepthFrame::kOutOfRange);
  sensor.min_range = 0.4;
  const DepthFrame near = SimulatedSensor(plane_at(0.39), sensor).acquire(Pose{});
  EXPECT_EQ(near.at(88, 72), DepthFrame::kInvalid);
  EXPECT_NEAR(near.at(0, 0), 0.39, 1e-5);
}

TEST(SimulatedSensor, NoiseIsGaussianAlongTheRayWithTheModelsSigma) {
  // Inside a sphere, seen from its centre: every ray meets it frontally at 1.5 m.
  const Sensor sensor = sensor_without_distortion();
  const SimulatedSensor simulated(far_away(), sensor,
                                  {.background_radius = 1.5, .noise = true, .seed = 9});
  const double sigma = sensor.sigmas(1.5).axial;
  double sum = 0;
  double sum_squares = 0;
  double neighbours = 0;
  int beyond_two = 0;
  int count = 0;
  for (std::uint64_t index = 0; index < 4; ++index) {
    const DepthFrame frame = simulated.acquire(Pose{}, index);
    double last = 0;
    for (int v = 0; v < frame.height; ++v) {
      for (int u = 0; u < frame.width; ++u) {
        const double z = (range_of(sensor, frame, u, v) - 1.5) / sigma;
        sum += z;
        sum_squares += z * z;
        neighbours += z * last;
        beyond_two += std::abs(z) > 2 ? 1 : 0;
        last = z;
        ++count;
      }
    }
  }
  ASSERT_EQ(count, 4 * 25'344);
  // Five standard errors of each statistic.
  const double n = count;
  EXPECT_NEAR(sum / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(sum_squares / n, 1, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(neighbours / n, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(beyond_two / n, 0.0455, 5 * std::sqrt(0.0455 / n));
}

TEST(SimulatedSensor, RefusesBadArguments) {
  Sensor sensor = sensor_without_distortion();
  EXPECT_THROW(SimulatedSensor(plane_at(1), sensor, {.background_radius = -1}), Error);
  const SimulatedSensor simulated(plane_at(1), sensor);
  Pose bad;
  bad.m[0] = 1.1;
  EXPECT_THROW((void)simulated.acquire(bad), Error);
  bad.m[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)simulated.acquire(bad), Error);
  sensor.camera.width = 0;
  EXPECT_THROW(SimulatedSensor(plane_at(1), sensor), Error);
}

TEST(SurfaceScene, NormalFollowsTheRightHandRule) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  mesh.triangles = {{0, 1, 2}};
  const Eigen::Vector3d from(0.2, 0.2, 0);
  EXPECT_NEAR(SurfaceScene(mesh).intersect({from}).normal.z(), 1, 1e-6);
  mesh.triangles = {{0, 2, 1}};
  EXPECT_NEAR(SurfaceScene(mesh).intersect({from}).normal.z(), -1, 1e-6);
}

TEST(SurfaceScene, MissesAndRespectsMaxRange) {
  const SurfaceScene scene(test::square_mesh(2.0, 1.0));
  const Eigen::Vector3d origin(0.1, 0.2, 0);
  const SurfaceScene::Hit away = scene.intersect({origin, -Eigen::Vector3d::UnitZ()});
  EXPECT_EQ(away.range, std::numeric_limits<double>::infinity());
  EXPECT_EQ(scene.intersect({{5, 0, 0}}).range, std::numeric_limits<double>::infinity());
  EXPECT_EQ(scene.intersect({origin, Eigen::Vector3d::UnitZ(), 0.999}).range,
            std::numeric_limits<double>::infinity());
  EXPECT_NEAR(scene.intersect({origin, Eigen::Vector3d::UnitZ(), 1.001}).range, 1.0, 1e-6);
}

// Rays from all round at a ball, which many miss: together, each by itself, and with the world's
// origin far away.
TEST(SurfaceScene, RaysAreWhatEachIsByItselfWhereverTheOriginIs) {
  const Eigen::Vector3d utm(500'000, 4'500'000, 400);
  const TriangleMesh ball = test::sphere_mesh(0.3, 40);
  TriangleMesh moved = ball;
  for (auto& v : moved.vertices) {
    for (std::size_t k = 0; k < 3; ++k) v[k] += utm[static_cast<Eigen::Index>(k)];
  }
  const SurfaceScene scene(ball), far_scene(moved);
  test::Random random(2);
  std::vector<SurfaceScene::Ray> rays;
  for (int i = 0; i < 1003; ++i) {
    const Eigen::Vector3d eye = test::random_rigid(random, 1).translation();
    const Eigen::Vector3d target = 0.5 * test::random_rigid(random, 1).translation();
    rays.push_back({eye, (target - eye).normalized(), i % 3 == 0 ? 0.4 : 10.0});
  }
  std::vector<SurfaceScene::Hit> hits(rays.size()), far_hits(rays.size());
  const auto blocked = std::make_unique<bool[]>(rays.size());
  scene.intersect(rays, hits);
  scene.block(rays, {blocked.get(), rays.size()});
  std::vector<SurfaceScene::Ray> far_rays = rays;
  for (SurfaceScene::Ray& ray : far_rays) ray.origin += utm;
  far_scene.intersect(far_rays, far_hits);
  int met = 0, at_edges = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SurfaceScene::Hit alone = scene.intersect(rays[i]);
    ASSERT_EQ(blocked[i], std::isfinite(hits[i].range));
    ASSERT_EQ(std::isfinite(alone.range), std::isfinite(hits[i].range));
    met += blocked[i] ? 1 : 0;
    if (std::isfinite(far_hits[i].range) != blocked[i]) {
      ++at_edges;
    } else if (blocked[i]) {
      ASSERT_NEAR(hits[i].range, alone.range, 1e-6);
      ASSERT_NEAR(far_hits[i].range, alone.range, 2e-6);
      const Eigen::Vector3d p = rays[i].origin + hits[i].range * rays[i].direction;
      ASSERT_NEAR(std::abs(hits[i].normal.dot(p.normalized())), 1, 4e-3);
    }
  }
  EXPECT_GT(met, 200);
  EXPECT_LT(met, 900);
  EXPECT_LE(at_edges, 2);
}

TEST(SurfaceScene, KeepsItsOwnCopyAndRefusesBadMeshes) {
  TriangleMesh mesh = test::square_mesh(2.0, 1.0);
  const SurfaceScene scene(mesh);
  EXPECT_EQ(scene.mesh().triangles.size(), 2U);
  EXPECT_THROW(SurfaceScene(TriangleMesh{}), Error);
  mesh.triangles[1][2] = 4;
  EXPECT_THROW((SurfaceScene(mesh)), Error);
  mesh = test::square_mesh(2.0, 1.0);
  mesh.vertices[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((SurfaceScene(mesh)), Error);
}

}  // namespace
}  // namespace viewgain
