// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/surface_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "raycast/scene_makers.hpp"
#include "surface_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

TEST(SurfaceScene, PlaneAtItsAnalyticDistance) {
  const SurfaceScene scene(test::square(2.0, 1.5));
  test::Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d origin(test::uniform(random, -1, 1), test::uniform(random, -1, 1), -0.5);
    const Eigen::Vector3d target(test::uniform(random, -1, 1), test::uniform(random, -1, 1), 1.5);
    const Eigen::Vector3d d = (target - origin).normalized();
    const SurfaceHit hit = scene.intersect({origin, d});
    EXPECT_NEAR(hit.range, (target - origin).norm(), 1e-6);
    EXPECT_NEAR(std::abs(hit.normal.z()), 1.0, 1e-6);
    EXPECT_LT(hit.triangle, 2U);
  }
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
  const SurfaceScene scene(test::square(2.0, 1.0));
  const Eigen::Vector3d origin(0.1, 0.2, 0);
  const SurfaceHit away = scene.intersect({origin, -Eigen::Vector3d::UnitZ()});
  EXPECT_EQ(away.range, std::numeric_limits<double>::infinity());
  EXPECT_EQ(scene.intersect({{5, 0, 0}}).range, std::numeric_limits<double>::infinity());
  EXPECT_EQ(scene.intersect({origin, Eigen::Vector3d::UnitZ(), 0.999}).range,
            std::numeric_limits<double>::infinity());
  EXPECT_NEAR(scene.intersect({origin, Eigen::Vector3d::UnitZ(), 1.001}).range, 1.0, 1e-6);
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
