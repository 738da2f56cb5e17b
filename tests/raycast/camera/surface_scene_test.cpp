// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/surface_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "raycast/scene_makers.hpp"
#include "surface_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

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
  const SurfaceScene scene(test::square(2.0, 1.0));
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
  const TriangleMesh ball = test::sphere(0.3, 40);
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
  TriangleMesh mesh = test::square(2.0, 1.0);
  const SurfaceScene scene(mesh);
  EXPECT_EQ(scene.mesh().triangles.size(), 2U);
  EXPECT_THROW(SurfaceScene(TriangleMesh{}), Error);
  mesh.triangles[1][2] = 4;
  EXPECT_THROW((SurfaceScene(mesh)), Error);
  mesh = test::square(2.0, 1.0);
  mesh.vertices[3][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((SurfaceScene(mesh)), Error);
}

}  // namespace
}  // namespace viewgain
