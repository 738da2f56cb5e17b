// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Strides, weights, obstacles, ranges, bad arguments.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oracle/gain.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

using test::kExactVoxel;

test::RandomCase make(std::uint64_t seed,
                      test::MapFamily family = test::MapFamily::salt_and_pepper_1) {
  return test::random_case(seed, family, 6);
}

TEST(GainOptions, StrideTakesEverySthPixelFromTheFirst) {
  const test::RandomCase made = make(50);
  const auto scene = VoxelScene::build(made.map.grid);
  const std::vector<RayHit> all = GainEvaluator(scene, made.sensor).trace(made.poses[1]);
  for (const int stride : {2, 3, 5, 100, std::numeric_limits<int>::max()}) {
    SCOPED_TRACE(stride);
    const GainEvaluator evaluator(scene, made.sensor, {.pixel_stride = stride});
    const std::vector<RayHit> some = evaluator.trace(made.poses[1]);
    std::size_t i = 0;
    for (std::int64_t v = 0; v < made.sensor.camera.height; v += stride) {
      for (std::int64_t u = 0; u < made.sensor.camera.width; u += stride, ++i) {
        const RayHit& expected = all[static_cast<std::size_t>(v * made.sensor.camera.width + u)];
        ASSERT_LT(i, some.size());
        EXPECT_TRUE(oracle::same_ending(expected, some[i]));
        EXPECT_EQ(expected.range, some[i].range);
      }
    }
    EXPECT_EQ(i, some.size());
    EXPECT_EQ(i, evaluator.rays_per_pose());
    EXPECT_EQ(i, evaluator.evaluate(made.poses[1]).rays);
  }
}

// A slab of unknown space fills the image, so that whichever rays are traced show the same: strides
// and samples that do not divide the image stand for all of it, and for no more.
TEST(GainOptions, TheRaysThatAreTracedStandForAllPixels) {
  BeliefGrid grid = BeliefGrid(GridConfig{0.01, {{-1, -1, 0}, {1, 1, 0.2}}, {}, 0.01});
  Sensor sensor = test::lattice_sensor(101, 83);
  sensor.camera.fx = sensor.camera.fy = 200;
  const Pose pose = look_at({0, 0, -1}, {0, 0, 0});
  const auto scene = VoxelScene::build(grid);
  const GainConfig config{.model = GainModel::surface};
  const GainEvaluator all(scene, sensor, config);
  const double area = all.evaluate(pose).area;
  EXPECT_GT(area, 1e-4);
  int cases = 0;
  for (const int stride : {2, 3, 7, 9}) {
    GainConfig some = config;
    some.pixel_stride = stride;
    EXPECT_NEAR(GainEvaluator(scene, sensor, some).evaluate(pose).area, area, 0.02 * area)
        << stride;
    ++cases;
  }
  for (const double share : {0.3, 0.1, 0.02, 0.01}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      ApproximateGain estimate;
      (void)all.approximate({&pose, 1}, {&estimate, 1}, {.share = share, .seed = seed});
      EXPECT_NEAR(estimate.gain, area, 0.02 * area) << share << ' ' << estimate.rays;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 44);
}

TEST(GainOptions, WeightsMultiplyVoxelsByTheLastRegionThatHoldsTheirCentre) {
  int weighed = 0;
  for (std::uint64_t seed = 100; seed < 110; ++seed) {
    const test::RandomCase made = make(seed, test::MapFamily::odd_and_far);
    const Box box = made.map.grid.workspace();
    Box half = box;
    half.max[0] = 0.5 * (box.min[0] + box.max[0]);
    Box quarter = half;
    quarter.max[1] = 0.5 * (box.min[1] + box.max[1]);
    const GainConfig config{.model = GainModel::paper, .weights = {{half, 3.0}, {quarter, 0.0}}};
    const auto scene = VoxelScene::build(made.map.grid);
    const GainEvaluator weighted(scene, made.sensor, config);
    for (const Pose& pose : made.poses) {
      const std::vector<RayHit> hits = weighted.trace(pose);
      const ViewGain expected =
          oracle::gain_of_hits(made.map.grid, made.sensor, config, pose, hits);
      const ViewGain actual = weighted.evaluate(pose);
      EXPECT_NEAR(actual.gain, expected.gain, 1e-6 * expected.gain);
      EXPECT_EQ(actual.unknown_voxels, expected.unknown_voxels);
      const double unweighted =
          oracle::gain_of_hits(made.map.grid, made.sensor, {}, pose, hits).gain;
      weighed += std::abs(actual.gain - unweighted) > 0.1 * unweighted ? 1 : 0;
    }
    const GainEvaluator plain(scene, made.sensor, test::kPaper);
    const GainEvaluator doubled(scene, made.sensor,
                                {.model = GainModel::paper, .weights = {{box, 2.0}}});
    EXPECT_NEAR(doubled.evaluate(made.poses[1]).gain, 2 * plain.evaluate(made.poses[1]).gain,
                1e-12 * plain.evaluate(made.poses[1]).gain);
  }
  EXPECT_GT(weighed, 30);
}

TEST(GainOptions, PriorAndRangesOverrideTheMapsAndTheSensors) {
  const test::RandomCase made = make(200, test::MapFamily::salt_and_pepper_30);
  const auto scene = VoxelScene::build(made.map.grid);
  EXPECT_EQ(GainEvaluator(scene, made.sensor).prior_sigma(), made.map.grid.prior_sigma());
  const GainConfig config{.model = GainModel::paper,
                          .prior_sigma = 0.123,
                          .min_range = 1.5 * made.map.grid.voxel_size(),
                          .max_range = 9.25 * made.map.grid.voxel_size()};
  const GainEvaluator evaluator(scene, made.sensor, config);
  EXPECT_EQ(evaluator.prior_sigma(), 0.123);
  int hits = 0;
  for (const Pose& pose : made.poses) {
    const std::vector<RayHit> own = evaluator.trace(pose);
    for (const RayHit& hit : own) {
      if (hit.kind == RayHit::Kind::none) continue;
      if (hit.kind == RayHit::Kind::obstacle) {  // known surface that is too near
        EXPECT_LT(hit.range, *config.min_range);
        continue;
      }
      EXPECT_GE(hit.range, *config.min_range * (1 - 1e-6));
      EXPECT_LE(hit.range, *config.max_range * (1 + 1e-6));
      ++hits;
    }
    const ViewGain expected = oracle::gain_of_hits(made.map.grid, made.sensor, config, pose, own);
    EXPECT_NEAR(evaluator.evaluate(pose).gain, expected.gain, 1e-6 * expected.gain);
  }
  EXPECT_GT(hits, 500);
}

TEST(GainOptions, ObstaclesInRandomMapsAgreeWithTheOracle) {
  std::size_t rays = 0;
  std::size_t same = 0;
  std::size_t explained = 0;
  std::size_t blocked = 0;
  for (std::uint64_t seed = 300; seed < 310; ++seed) {
    const test::RandomCase made = make(seed, test::MapFamily::rotated);
    const BeliefGrid& grid = made.map.grid;
    // Boxes are in the world, the map is turned against it; cameras stay outside of them.
    const Box w = grid.workspace();
    const Eigen::Vector3d c = grid.T_world_grid() * Eigen::Vector3d(0.5 * (w.min[0] + w.max[0]),
                                                                    0.5 * (w.min[1] + w.max[1]),
                                                                    0.5 * (w.min[2] + w.max[2]));
    const double e = 0.15 * (w.max[0] - w.min[0]);
    const Obstacles obstacles{
        {Box{{c.x() - e, c.y() - e, c.z() - e}, {c.x() + e, c.y() + e, c.z() + 0.5 * e}}}, {}};
    const GainEvaluator evaluator(VoxelScene::build(grid, {obstacles}), made.sensor, test::kPaper);
    const oracle::DenseMap map(grid);
    for (const Pose& pose : made.poses) {
      const Eigen::Vector3d off = (pose.translation() - c).cwiseAbs();
      if (off.maxCoeff() <= 1.01 * e) continue;
      const std::vector<RayHit> own = evaluator.trace(pose);
      const std::vector<oracle::Ray> view =
          oracle::view_rays(map.T_world_grid, map.voxel_size, made.sensor.camera, 1, pose);
      oracle::RayLimits limits = oracle::limits_of(map, made.sensor, {});
      for (std::size_t i = 0; i < view.size(); ++i) {
        const double range = oracle::obstacle_range(map, obstacles, view[i]);
        // What lies beyond max_range is not worth a name.
        limits.obstacle_range =
            range <= limits.max_range ? range : std::numeric_limits<double>::infinity();
        RayHit actual = own[i];
        if (actual.kind == RayHit::Kind::obstacle &&
            actual.range > limits.max_range * map.voxel_size) {
          actual = {};
        }
        const RayHit expected = oracle::first_hit(map, view[i], limits);
        ++rays;
        blocked += expected.kind == RayHit::Kind::obstacle ? 1 : 0;
        if (oracle::same_ending(expected, actual)) {
          ++same;
        } else if (oracle::is_tie(map, view[i], limits, actual)) {
          ++explained;
        }
      }
    }
  }
  EXPECT_GT(rays, 20'000U);
  EXPECT_GT(blocked, 500U);
  EXPECT_EQ(same + explained, rays);
  EXPECT_GE(static_cast<double>(same), 0.999 * static_cast<double>(rays));
}

// An obstacle's face on a voxel's face: the obstacle wins; and a ray
// through the diagonal that a box face's two triangles share does not slip through.
TEST(GainOptions, ObstaclesWinTiesAndHaveNoSeams) {
  const double v = kExactVoxel;
  for (const std::string& isa : available_isas()) {
    const test::ScopedIsa scoped(isa);
    for (const VoxelState state : {VoxelState::occupied, VoxelState::unknown}) {
      std::vector<Index3> wall;
      for (int y = 0; y < 16; ++y) {
        for (int z = 0; z < 16; ++z) wall.push_back({8, y, z});
      }
      const BeliefGrid grid = test::sparse_map({16, 16, 16}, wall, state);
      const Obstacles obstacles{{Box{{8 * v, 0, 0}, {9 * v, 16 * v, 16 * v}}}, {}};
      const GainEvaluator evaluator(VoxelScene::build(grid, {obstacles}),
                                    test::lattice_sensor(3, 3), test::kPaper);
      for (const Eigen::Vector3d& eye :
           {Eigen::Vector3d(-2, 8, 8), Eigen::Vector3d(-2, 3.5, 3.5), Eigen::Vector3d(2, 5, 11)}) {
        const Pose pose = test::axis_pose(eye, 0, true);
        const std::vector<RayHit> hits = evaluator.trace(pose);
        EXPECT_EQ(hits.at(4).kind, RayHit::Kind::obstacle);
        EXPECT_NEAR(hits.at(4).range, (8 - eye.x()) * v, 1e-6);
        EXPECT_EQ(evaluator.evaluate(pose).gain, 0.0);
      }
    }
  }
}

TEST(GainOptions, PriorsAndSigmasThatDoublePrecisionCannotWeighAreRefused) {
  const auto scene = VoxelScene::build(make(3).map.grid);
  Sensor sensor = test::lattice_sensor(3, 3);
  for (const double prior : {1e-7, 2e3, 1e-11, 1e20}) {
    EXPECT_THROW(GainEvaluator(scene, sensor, {.prior_sigma = prior}), Error) << prior;
  }
  for (const double prior : {1e-6, 1e3}) {
    EXPECT_NO_THROW(GainEvaluator(scene, sensor, {.prior_sigma = prior})) << prior;
  }
  sensor.noise = ConstantNoise{1e-9, 1e-2};
  EXPECT_THROW(GainEvaluator(scene, sensor), Error);
  sensor.noise = ConstantNoise{0.9e-8, 1e-7};
  EXPECT_THROW(GainEvaluator(scene, sensor), Error);
  sensor.noise = ConstantNoise{1e-7, 0.9e-8};
  EXPECT_THROW(GainEvaluator(scene, sensor), Error);
  sensor.noise = ConstantNoise{1e-8, 1e-8};
  EXPECT_NO_THROW(GainEvaluator(scene, sensor));
}

TEST(GainOptions, BadArgumentsAreNamed) {
  const BeliefGrid grid = test::sparse_map({8, 8, 8}, {{4, 4, 4}});
  const auto scene = VoxelScene::build(grid);
  const Sensor sensor = test::lattice_sensor(3, 3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<GainConfig> bad{
      {.pixel_stride = 0},
      {.prior_sigma = -1.0},
      {.min_range = -0.1},
      {.min_range = 2.0, .max_range = 1.0},
      {.max_range = nan},
      {.weights = {{Box{{0, 0, 0}, {1, 1, 1}}, -1.0}}},
      {.weights = {{Box{{0, 0, 0}, {1, 1, 1}}, nan}}},
      {.weights = {{Box{{0, 0, 2}, {1, 1, 1}}, 1.0}}},
  };
  for (std::size_t i = 0; i < bad.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_THROW(GainEvaluator(scene, sensor, bad[i]), Error);
  }
  EXPECT_THROW(GainEvaluator(nullptr, sensor), Error);
  Sensor broken = sensor;
  broken.camera.fx = 0;
  EXPECT_THROW(GainEvaluator(scene, broken), Error);
  TriangleMesh wild;
  wild.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  wild.triangles = {{0, 1, 7}};
  EXPECT_THROW((void)VoxelScene::build(grid, {{{}, {wild}}}), Error);
  wild.triangles = {{0, 1, 2}};
  wild.vertices[2][1] = nan;
  EXPECT_THROW((void)VoxelScene::build(grid, {{{}, {wild}}}), Error);
  EXPECT_THROW((void)VoxelScene::build(grid, {{{Box{{1, 0, 0}, {0, 1, 1}}}, {}}}), Error);
  for (const int threads : {-1, 1025}) {
    EXPECT_THROW((void)VoxelScene::build(grid, {}, {.num_threads = threads}), Error);
    EXPECT_THROW((void)VoxelScene::update(scene, grid, {.num_threads = threads}), Error);
    EXPECT_THROW(GainEvaluator(scene, sensor, {}, {.num_threads = threads}), Error);
  }
}

}  // namespace
}  // namespace viewgain
