// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Views that show what is too near to be measured, against the oracle's rays; batches, and checkers
// that follow a map.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "grid/voxels.hpp"
#include "oracle/rays.hpp"
#include "raycast/scene_makers.hpp"
#include "solids.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {
namespace {

using test::MapFamily;

constexpr int kMaps = test::kSlowBuild ? 3 : 6;
constexpr std::size_t kPoses = 30;

/// As wide as its stride of 8 allows rays, with and without distortion.
Sensor sensor_for(const BeliefGrid& grid, test::Random& random) {
  Sensor sensor = test::random_sensor(grid, random);
  sensor.camera.width = 121;
  sensor.camera.height = 99;
  sensor.camera.fx = test::uniform(random, 60, 140);
  sensor.camera.fy = sensor.camera.fx;
  sensor.camera.cx = 58;
  sensor.camera.cy = 51;
  sensor.min_range = test::uniform(random, 1, 12) * grid.voxel_size();
  sensor.max_range = sensor.min_range + test::uniform(random, 2, 60) * grid.voxel_size();
  sensor.working_distance = sensor.min_range + 0.5 * grid.voxel_size();
  return sensor;
}

/// A body so small that only what the camera stands in counts.
FeasibilityConfig config_for(const Sensor& sensor, double share) {
  FeasibilityConfig config;
  config.body.size = {1e-6, 1e-6, 1e-6};
  config.sensor = sensor;
  config.max_near_share = share;
  return config;
}

Obstacles random_obstacles(const BeliefGrid& grid, test::Random& random) {
  const double reach = 40 * grid.voxel_size();
  const Eigen::Vector3d center =
      grid.T_world_grid() *
      Eigen::Vector3d(grid.voxel_size() * (grid.min_index().x + grid.dims().x / 2),
                      grid.voxel_size() * (grid.min_index().y + grid.dims().y / 2),
                      grid.voxel_size() * (grid.min_index().z + grid.dims().z / 2));
  const auto near_it = [&](double scale) {
    return Eigen::Vector3d(center + scale * reach * test::random_rigid(random, 1).translation());
  };
  Obstacles obstacles;
  TriangleMesh sheets;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = near_it(0.7);
    const Eigen::Vector3d size =
        Eigen::Vector3d::Constant(0.02 * reach) +
        0.2 * reach * test::random_rigid(random, 1).translation().cwiseAbs();
    obstacles.boxes.push_back(
        {{a.x(), a.y(), a.z()}, {a.x() + size.x(), a.y() + size.y(), a.z() + size.z()}});
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = near_it(0.7);
      sheets.vertices.push_back({p.x(), p.y(), p.z()});
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    sheets.triangles.push_back({first, first + 1, first + 2});
  }
  obstacles.meshes.push_back(sheets);
  return obstacles;
}

TEST(Sight, IsWhatTheOraclesRaysSay) {
  test::Random random(41);
  std::size_t asked = 0, too_near = 0, some_near = 0, changed_by_obstacles = 0;
  for (const MapFamily family :
       {MapFamily::salt_and_pepper_01, MapFamily::salt_and_pepper_1, MapFamily::salt_and_pepper_30,
        MapFamily::tiles_8, MapFamily::tiles_128, MapFamily::rotated}) {
    for (int i = 0; i < kMaps; ++i) {
      const test::RandomMap made = test::random_map(family, random);
      const oracle::DenseMap map(made.grid);
      const Sensor sensor = sensor_for(made.grid, random);
      const Obstacles obstacles = i % 2 == 0 ? Obstacles{} : random_obstacles(made.grid, random);
      const double share = i % 5 == 0 ? 0.0 : test::uniform(random, 0.02, 0.9);
      const FeasibilityChecker checker(VoxelScene::build(made.grid, {obstacles}),
                                       config_for(sensor, share));
      const GainConfig from_the_lens{.pixel_stride = 8, .min_range = 0.0};
      for (const Pose& pose : test::random_poses(made, kPoses, random)) {
        const Infeasibility answer = checker.check(pose);
        if (answer != Infeasibility::none && answer != Infeasibility::too_near) continue;
        const auto counts = [&](const Obstacles& in_the_way) {
          std::pair<std::size_t, std::size_t> near_and_all{0, 0};
          for (const RayHit& hit : oracle::trace(map, sensor, from_the_lens, pose, in_the_way)) {
            if (hit.kind != RayHit::Kind::unknown && hit.kind != RayHit::Kind::occupied) continue;
            near_and_all.first += hit.range < sensor.min_range ? 1U : 0U;
            ++near_and_all.second;
          }
          return near_and_all;
        };
        const auto is_near = [&](const std::pair<std::size_t, std::size_t>& near_and_all) {
          return static_cast<double>(near_and_all.first) >
                 share * static_cast<double>(near_and_all.second);
        };
        const auto told = counts(obstacles);
        ASSERT_EQ(answer == Infeasibility::too_near, is_near(told))
            << "family " << static_cast<int>(family) << ", map " << i << ", " << told.first
            << " near of " << told.second << ", share " << share;
        ++asked;
        too_near += answer == Infeasibility::too_near ? 1U : 0U;
        some_near += answer == Infeasibility::none && told.first > 0 ? 1U : 0U;
        if (i % 2 == 1) changed_by_obstacles += is_near(counts({})) != is_near(told) ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(asked, 6U * kMaps * kPoses / 3);
  EXPECT_GT(too_near, asked / 10);
  EXPECT_GT(some_near, asked / 50);
  EXPECT_GT(changed_by_obstacles, asked / 500);
}

TEST(Sight, ABatchIsItsPosesOnAnyNumberOfThreads) {
  test::Random random(42);
  const test::RandomMap made = test::random_map(MapFamily::tiles_8, random);
  const auto scene = VoxelScene::build(made.grid, {random_obstacles(made.grid, random)});
  const FeasibilityConfig config = config_for(sensor_for(made.grid, random), 0.2);
  std::vector<Pose> poses = test::random_poses(made, 500, random);
  poses[7].m[3] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Pose> taken{poses[100], poses[200]};
  const FeasibilityChecker alone(scene, config, {.num_threads = 1});
  std::vector<Infeasibility> expected;
  std::map<Infeasibility, int> reasons;
  for (const Pose& pose : poses) {
    expected.push_back(alone.check(pose, taken));
    ++reasons[expected.back()];
  }
  EXPECT_GE(reasons.size(), 5U);  // bad_pose, taken, collision, too_near, none
  EXPECT_EQ(alone.check(poses, taken), expected);
  const FeasibilityChecker together(scene, config, {.num_threads = 3});
  for (int run = 0; run < 5; ++run) EXPECT_EQ(together.check(poses, taken), expected);
  EXPECT_TRUE(together.check(std::span<const Pose>()).empty());
  EXPECT_THROW(FeasibilityChecker(scene, config, {.num_threads = -1}), Error);

  FeasibilityConfig throwing = config;
  throwing.reach.predicate = [](const Pose&) -> bool { throw std::runtime_error("arm"); };
  EXPECT_THROW((void)FeasibilityChecker(scene, throwing).check(poses), std::runtime_error);
}

TEST(Sight, ACheckerFollowsAMap) {
  test::Random random(43);
  test::RandomMap made = test::random_map(MapFamily::salt_and_pepper_1, random);
  const Obstacles obstacles = random_obstacles(made.grid, random);
  const FeasibilityConfig config = config_for(sensor_for(made.grid, random), 0.1);
  auto scene = VoxelScene::build(made.grid, {obstacles});
  FeasibilityChecker checker(scene, config);
  const FeasibilityChecker first = checker.with_scene(scene);
  const std::vector<Pose> poses = test::random_poses(made, 200, random);
  const std::vector<Infeasibility> before = checker.check(poses);
  std::size_t steps = 0, changed = 0;
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 300; ++k) {
      const Index3 min = made.grid.min_index(), dims = made.grid.dims();
      made.grid.set({min.x + test::uniform_int(random, 0, dims.x - 1),
                     min.y + test::uniform_int(random, 0, dims.y - 1),
                     min.z + test::uniform_int(random, 0, dims.z - 1)},
                    k % 2 == 0 ? 0.85F : -1.0F);
    }
    scene = VoxelScene::update(scene, made.grid);
    EXPECT_EQ(&scene->surroundings(), &first.scene().surroundings());
    checker = checker.with_scene(scene);
    const std::vector<Infeasibility> now = checker.check(poses);
    EXPECT_EQ(now,
              FeasibilityChecker(VoxelScene::build(made.grid, {obstacles}), config).check(poses));
    changed += now != before ? 1U : 0U;
    ++steps;
  }
  EXPECT_EQ(steps, 10U);
  EXPECT_EQ(changed, 10U);
  EXPECT_EQ(first.check(poses), before);

  // Other obstacles are looked at anew.
  const FeasibilityChecker walled = checker.with_scene(
      VoxelScene::build(made.grid, {{{{{-1e3, -1e3, -1e3}, {1e3, 1e3, 1e3}}}, {}}}));
  for (const Infeasibility reason : walled.check(poses)) {
    EXPECT_EQ(reason, Infeasibility::obstacle);
  }
  EXPECT_THROW((void)checker.with_scene(nullptr), Error);
}

// Bodies in maps of many regions, and in closed meshes of many triangles.

// Across the borders of blocks of 8³, 32³ and 128³ voxels and of the workspace, some of them
// unknown as a whole, against each voxel by itself.
TEST(Bodies, AcrossManyRegionsMeetWhatTheyWouldVoxelByVoxel) {
  constexpr double kVoxel = 0.01;  // [m]
  const Index3 min{-133, -20, -5}, dims{270, 71, 141};
  const auto face = [](int i) { return kVoxel * i; };
  test::Random random(45);
  std::map<Infeasibility, int> answers;
  int in_large_tiles = 0;
  for (const bool has_large_tiles : {false, true}) {
    const GridConfig config{kVoxel,
                            {{face(min.x), face(min.y), face(min.z)},
                             {face(min.x + dims.x), face(min.y + dims.y), face(min.z + dims.z)}},
                            test::random_rigid(random, 2),
                            0.01};
    std::vector<test::Solid> non_free;
    const Eigen::Matrix3d R = config.T_world_grid.rotation();
    const auto add = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
      non_free.push_back(
          {config.T_world_grid * (0.5 * kVoxel * (low + high)), R, 0.5 * kVoxel * (high - low)});
    };
    std::vector<std::uint8_t> states(static_cast<std::size_t>(dims.x * dims.y * dims.z), 1);
    const auto make_unknown = [&](const Index3& low, const Index3& high) {
      const VoxelBox box = VoxelBox{low, high}.intersection(VoxelBox::from_dims(min, dims));
      test::for_each_voxel(box, [&](Index3 v) {
        const int row = (v.x - min.x) * dims.y + v.y - min.y;
        states[static_cast<std::size_t>(row * dims.z + v.z - min.z)] = 0;
      });
      const auto corner = [](Index3 v) { return Eigen::Vector3d(v.x, v.y, v.z); };
      if (box.volume() > 0) add(corner(box.min), corner(box.max));
    };
    const auto anywhere = [&] {
      return Index3{test::uniform_int(random, min.x, min.x + dims.x - 1),
                    test::uniform_int(random, min.y, min.y + dims.y - 1),
                    test::uniform_int(random, min.z, min.z + dims.z - 1)};
    };
    for (int i = 0; i < 150; ++i) {
      const Index3 at = anywhere();
      make_unknown(at, {at.x + 1, at.y + 1, at.z + 1});
      const Index3 block{at.y & ~7, at.x / 4 & ~7, at.z & ~7};
      if (i % 10 == 0) make_unknown(block, {block.x + 8, block.y + 8, block.z + 8});
    }
    if (has_large_tiles) make_unknown({-256, -128, 0}, {-128, 128, 128});
    const BeliefGrid grid = BeliefGrid::from_states(config, states);
    const GridSnapshot snapshot = grid.snapshot();
    ASSERT_GT(snapshot.regions.size(), 60U);
    ASSERT_EQ(snapshot.tiles_of(0)[0] > 0, has_large_tiles);
    const auto scene = VoxelScene::build(snapshot);

    for (int i = 0; i < 1500; ++i) {
      FeasibilityConfig body;
      const double largest = std::array{0.02, 0.1, 0.4}[static_cast<std::size_t>(i % 3)];
      for (double& size : body.body.size) size = test::uniform(random, 0.002, largest);
      const Index3 near = anywhere();
      const Eigen::Vector3d eye =
          config.T_world_grid *
          (kVoxel *
           Eigen::Vector3d(1.05 * near.x + 0.37, 1.05 * near.y + 0.41, 1.05 * near.z + 0.39));
      const Pose pose(test::random_rigid(random, 1).rotation(), eye);
      const Eigen::Vector3d half =
          0.5 * Eigen::Vector3d(body.body.size[0], body.body.size[1], body.body.size[2]);
      const test::Solid solid{eye - pose.rotation().col(2) * half.z(), pose.rotation(), half};
      const auto meets = [&](const test::Solid& voxels) {
        return voxels.contains(eye) ||
               ((voxels.center - solid.center).norm() < voxels.half.norm() + half.norm() &&
                test::overlap(solid, voxels));
      };
      const bool expected = std::any_of(non_free.begin(), non_free.end(), meets);
      const Infeasibility answer = FeasibilityChecker(scene, body).check(pose);
      ASSERT_EQ(answer, expected ? Infeasibility::collision : Infeasibility::none) << i;
      ++answers[answer];
      in_large_tiles += has_large_tiles && meets(non_free.back()) ? 1 : 0;
    }
  }
  EXPECT_GT(answers[Infeasibility::none], 500);
  EXPECT_GT(answers[Infeasibility::collision], 300);
  EXPECT_GT(in_large_tiles, 20);
}

// Bodies that a closed mesh may hold as a whole, where the line that asks goes through faces, along
// edges and through corners.
TEST(Bodies, InsideAClosedMeshAreInTheWay) {
  constexpr int kRings = 24;
  TriangleMesh ball;  // a sphere's meridians and circles of latitude, poles along x
  const auto corner = [&](int ring, int k) {
    const double polar = std::numbers::pi * ring / kRings, turn = 2 * std::numbers::pi * k / kRings;
    const double s = ring == 0 || ring == kRings ? 0.0 : std::sin(polar);
    return std::array<double, 3>{std::cos(polar), s * std::cos(turn), s * std::sin(turn)};
  };
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int k = 0; k < kRings; ++k) ball.vertices.push_back(corner(ring, k));
  }
  const auto number = [&](int ring, int k) {
    return static_cast<std::uint32_t>(ring * kRings + k % kRings);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < kRings; ++k) {
      ball.triangles.push_back({number(ring, k), number(ring + 1, k), number(ring + 1, k + 1)});
      ball.triangles.push_back({number(ring, k), number(ring + 1, k + 1), number(ring, k + 1)});
    }
  }
  const BeliefGrid grid = test::sparse_map({8, 8, 8}, {});
  FeasibilityConfig config;
  config.body.size = {1e-3, 1e-3, 1e-3};
  const FeasibilityChecker checker(VoxelScene::build(grid, {{{}, {ball}}}), config);
  test::Random random(44);
  std::size_t inside = 0, outside = 0;
  const auto ask = [&](const Eigen::Vector3d& p) {
    const double r = p.norm();
    if (r > 0.98 && r < 1.005) return;  // the polyhedron's faces lie within the sphere
    const bool is_inside = r <= 0.98;
    const Pose pose(Eigen::Matrix3d::Identity(), p + Eigen::Vector3d(0, 0, 5e-4));
    EXPECT_EQ(checker.check(pose) == Infeasibility::obstacle, is_inside) << p.transpose();
    ++(is_inside ? inside : outside);
  };
  for (int i = 0; i < 3000; ++i) ask(1.3 * test::random_rigid(random, 1).translation());
  for (const double x : {-2.0, -0.5, 0.0, 0.3, 1.5}) {
    ask({x, 0, 0});  // through both poles
    for (int ring = 1; ring < kRings; ++ring) {
      for (int k = 0; k < kRings; ++k) {
        const auto c = corner(ring, k), d = corner(ring + 1, k);
        ask({x, c[1], c[2]});
        ask({x, 0.5 * (c[1] + d[1]), 0.5 * (c[2] + d[2])});
      }
    }
  }
  EXPECT_GT(inside, 2000U);
  EXPECT_GT(outside, 2000U);
}

}  // namespace
}  // namespace viewgain
