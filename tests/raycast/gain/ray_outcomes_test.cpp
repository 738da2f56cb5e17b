// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What becomes of a view's rays: against the oracle's rays, and by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "oracle/rays.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {
namespace {
using RayOutcomes = GainEvaluator::RayOutcomes;

using Kind = RayHit::Kind;

std::uint32_t sum(const RayOutcomes& o) {
  return o.too_near + o.unknown + o.known_surface + o.obstacle + o.out_of_range + o.out_of_map;
}

// The oracle walks its rays in double precision; some graze voxels that ours do not.
std::uint32_t difference(const RayOutcomes& a, const RayOutcomes& b) {
  const auto off = [](std::uint32_t x, std::uint32_t y) { return x > y ? x - y : y - x; };
  return off(a.too_near, b.too_near) + off(a.unknown, b.unknown) +
         off(a.known_surface, b.known_surface) + off(a.obstacle, b.obstacle) +
         off(a.out_of_range, b.out_of_range) + off(a.out_of_map, b.out_of_map);
}

// What lies beyond the limit [m] is not met.
Kind within(const RayHit& hit, double limit) { return hit.range > limit ? Kind::none : hit.kind; }

TEST(RayOutcomes, AreThoseOfTheOraclesRays) {
  std::uint32_t rays = 0, off = 0;
  RayOutcomes seen;
  int cases = 0;
  for (const test::MapFamily family : test::kMapFamilies) {
    test::Random random(70 + static_cast<std::uint64_t>(family));
    const test::RandomMap made = test::random_map(family, random);
    Sensor sensor = test::random_sensor(made.grid, random);
    const oracle::DenseMap map(made.grid);
    const double v = made.grid.voxel_size();
    // An obstacle among what is seen, and limits that some rays reach.
    const Obstacles obstacles{{Box{{0, 0, 0}, {4 * v, 3 * v, 5 * v}}}, {}};
    sensor.min_range = 4 * v;
    sensor.max_range = 30 * v;
    sensor.working_distance = 10 * v;
    const auto scene = VoxelScene::build(made.grid, {obstacles});
    const GainEvaluator evaluator(scene, sensor);
    GainConfig near_only;
    near_only.min_range = 0;
    near_only.max_range = sensor.min_range;
    for (const Pose& pose : test::random_poses(made, 4, random)) {
      const RayOutcomes found = evaluator.outcomes(pose);
      EXPECT_EQ(sum(found), found.rays);
      EXPECT_EQ(found.rays, evaluator.evaluate(pose).rays);
      const auto far = oracle::trace(map, sensor, {}, pose, obstacles);
      const auto near = oracle::trace(map, sensor, near_only, pose, obstacles);
      const auto view = oracle::view_rays(map.T_world_grid, v, sensor.camera, 1, pose);
      RayOutcomes expected;
      for (std::size_t i = 0; i < far.size(); ++i) {
        const Eigen::Vector3d end = view[i].origin + view[i].direction * (sensor.max_range / v);
        const Index3 last{static_cast<std::int32_t>(std::floor(end.x())),
                          static_cast<std::int32_t>(std::floor(end.y())),
                          static_cast<std::int32_t>(std::floor(end.z()))};
        const Kind before = within(near[i], sensor.min_range),
                   kind = within(far[i], sensor.max_range);
        if (before == Kind::occupied || before == Kind::obstacle) {
          ++expected.too_near;
        } else if (kind == Kind::none) {
          ++(map.inside(last) ? expected.out_of_range : expected.out_of_map);
        } else {
          ++(kind == Kind::unknown    ? expected.unknown
             : kind == Kind::occupied ? expected.known_surface
                                      : expected.obstacle);
        }
      }
      rays += found.rays;
      off += difference(found, expected);
      seen.too_near += found.too_near;
      seen.unknown += found.unknown;
      seen.known_surface += found.known_surface;
      seen.obstacle += found.obstacle;
      seen.out_of_range += found.out_of_range;
      seen.out_of_map += found.out_of_map;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 28);
  EXPECT_LE(off, rays / 1000) << "of " << rays;
  for (const std::uint32_t count : {seen.too_near, seen.unknown, seen.known_surface, seen.obstacle,
                                    seen.out_of_range, seen.out_of_map}) {
    EXPECT_GT(count, rays / 500);
  }
}

// Free space and a plane across it: by the surface gains rays end there, by the paper's they leave.
TEST(RayOutcomes, TheSupportPlaneEndsRaysOfTheSurfaceGains) {
  BeliefGrid grid({0.1, {{-2, -2, 0}, {2, 2, 3}}, {}, 0.05});
  for (std::int32_t i = 0; i < 40 * 40 * 30; ++i) {
    const std::int32_t z = i % 30;
    if (z >= 2) grid.set({i / 1200 - 20, i / 30 % 40 - 20, z}, -1.0F);
  }
  Sensor sensor = sensor_preset("sr4000");
  sensor.min_range = 0.2;
  const Pose down = look_at({0.02, 0.03, 1.5}, {0.02, 0.03, 0}, Eigen::Vector3d::UnitX());
  const auto count = [&](GainModel model, double plane, double min_range) {
    GainConfig config;
    config.model = model;
    config.min_range = min_range;
    return GainEvaluator(VoxelScene::build(grid, {{}, plane}), sensor, config).outcomes(down);
  };
  const RayOutcomes seen = count(GainModel::combined, 0.5, 0.2);
  EXPECT_EQ(seen.obstacle, seen.rays);
  EXPECT_EQ(count(GainModel::combined, 0.5, 1.6).too_near, seen.rays);
  EXPECT_EQ(count(GainModel::paper, 0.5, 0.2).unknown, seen.rays);  // the layers below
  EXPECT_EQ(count(GainModel::surface, 0.1, 0.2).unknown, seen.rays);
  EXPECT_EQ(count(GainModel::surface, 2.0, 0.2).unknown, seen.rays);  // it is above the camera
}

TEST(RayOutcomes, OfABadPoseAreNone) {
  test::Random random(3);
  const test::RandomMap made = test::random_map(test::MapFamily::salt_and_pepper_1, random);
  const GainEvaluator evaluator(VoxelScene::build(made.grid),
                                test::random_sensor(made.grid, random));
  const Pose bad{Eigen::Matrix3d::Identity(), {std::nan(""), 0, 0}};
  EXPECT_EQ(evaluator.outcomes(bad).rays, 0U);
}

}  // namespace
}  // namespace viewgain
