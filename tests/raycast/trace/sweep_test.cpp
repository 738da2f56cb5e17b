// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What sweeping views has special ways for, under each instruction set, held against Embree's BVH
// over the same boxes: primitives that are small in the image, cells larger than a node of 128³
// voxels, and cameras among the cells, on their faces and far off.
#include <gtest/gtest.h>

#include <algorithm>

#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

// Compares gains and hits of the two ways; returns the number of rays that hit something.
std::size_t compare(const BeliefGrid& grid, const Sensor& sensor, const std::vector<Pose>& poses,
                    const Obstacles& obstacles = {}) {
  std::size_t hits = 0;
  for (const std::string& isa : available_isas()) {
    SCOPED_TRACE(isa);
    const test::ScopedIsa scoped(isa);
    const auto scene = VoxelScene::build(grid, {obstacles});
    const GainEvaluator sweep(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::sweep});
    const GainEvaluator bvh(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::embree});
    EXPECT_TRUE(test::same_bits(sweep.evaluate(poses), bvh.evaluate(poses)));
    for (const Pose& pose : poses) {
      const std::vector<RayHit> a = sweep.trace(pose), b = bvh.trace(pose);
      EXPECT_EQ(a.size(), b.size());
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        const bool same =
            a[i].kind == b[i].kind && a[i].voxel == b[i].voxel && a[i].range == b[i].range;
        wrong += same ? 0U : 1U;
        hits += a[i].kind == RayHit::Kind::none ? 0U : 1U;
      }
      EXPECT_EQ(wrong, 0U);
    }
  }
  return hits / available_isas().size();
}

// The middle of the workspace in the world, and half its diagonal [m].
struct Ball {
  Eigen::Vector3d middle;
  double radius;
};
Ball ball_round(const BeliefGrid& grid) {
  const Box box = grid.workspace();
  const Eigen::Vector3d low(box.min[0], box.min[1], box.min[2]),
      high(box.max[0], box.max[1], box.max[2]);
  return {grid.T_world_grid() * Eigen::Vector3d(0.5 * (low + high)), 0.5 * (high - low).norm()};
}

// Blocks of 8³ voxels are from a fifth of a ray to twelve rays wide, so that several primitives
// share a window, or a primitive takes many; images end between tiles.
TEST(Sweep, PrimitivesOfAllSizesInTheImageGiveTheSameBits) {
  std::size_t hits = 0, cases = 0;
  for (const test::MapFamily family :
       {test::MapFamily::salt_and_pepper_1, test::MapFamily::salt_and_pepper_30,
        test::MapFamily::tiles_8, test::MapFamily::rotated}) {
    for (const double rays : {0.2, 0.9, 2.0, 3.9, 4.2, 12.0}) {
      test::Random random(300 + cases);
      const test::RandomMap map = test::random_map(family, random);
      const Ball ball = ball_round(map.grid);
      const double distance = 3 * ball.radius;
      Sensor sensor = test::random_sensor(map.grid, random);
      sensor.camera = {.width = 70, .height = 51, .cx = 34.3, .cy = 25.8};
      sensor.camera.fx = sensor.camera.fy = rays * distance / (8 * map.grid.voxel_size());
      if (cases % 3 == 0) sensor.min_range = distance;
      sensor.max_range = distance + (cases % 3 == 1 ? 0.2 : 2.0) * ball.radius;
      sensor.working_distance = 0.5 * (sensor.min_range + sensor.max_range);
      std::vector<Pose> poses;
      for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d away = test::random_rigid(random, 0).rotation().col(0);
        poses.push_back(look_at(
            ball.middle + distance * away,
            ball.middle + 0.3 * ball.radius * test::random_rigid(random, 0).rotation().col(1),
            test::random_rigid(random, 0).rotation().col(0)));
      }
      hits += compare(map.grid, sensor, poses);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 24U);
  EXPECT_GT(hits, 20'000U);
}

// A workspace of which nothing is known but a room beside its corner: its unknown part is boxes
// that reach over many nodes, before and behind the blocks of the room.
TEST(Sweep, BoxesLargerThanNodesGiveTheSameBits) {
  constexpr double kVoxel = 0.02;
  test::Random random(11);
  const auto face = [](int i) { return kVoxel * i; };
  BeliefGrid grid(
      GridConfig{.voxel_size = kVoxel,
                 .workspace = {{face(4000), face(-30), face(-5)}, {face(4300), face(90), face(70)}},
                 .prior_sigma = 0.02});
  // The workspace crosses a boundary of the tree's largest nodes, at 4096; what lies beyond it
  // stays boxes that are 204 voxels long.
  for (int x = 4000; x < 4050; ++x) {
    for (int y = 0; y < 60; ++y) {
      for (int z = 0; z < 50; ++z) {
        if (test::uniform(random, 0, 1) < 0.03) continue;
        grid.set({x, y, z}, test::uniform(random, 0, 1) < 0.01 ? 0.85F : -0.4F);
      }
    }
  }
  const GridSnapshot snapshot = grid.snapshot();
  const auto is_larger = [](const VoxelBox& box) {
    return box.min.x >> 7 != (box.max.x - 1) >> 7 || box.min.y >> 7 != (box.max.y - 1) >> 7 ||
           box.min.z >> 7 != (box.max.z - 1) >> 7;
  };
  ASSERT_TRUE(std::any_of(snapshot.tiles.begin(), snapshot.tiles.end(), is_larger));
  Sensor sensor = test::lattice_sensor(61, 47);
  sensor.camera.fx = sensor.camera.fy = 50;
  sensor.min_range = 0.05;
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d inside(face(4000 + test::uniform_int(random, 2, 48)),
                                 face(test::uniform_int(random, 2, 58)),
                                 face(test::uniform_int(random, 2, 48)));
    const Eigen::Vector3d away = test::random_rigid(random, 0).rotation().col(0);
    poses.push_back(look_at(inside, inside + away));
    poses.push_back(look_at(inside + 4.0 * away, inside));
  }
  EXPECT_GT(compare(grid, sensor, poses), 24U * 61U * 47U / 4);
  Obstacles obstacles;
  obstacles.boxes.push_back({{face(4020), face(10), face(10)}, {face(4030), face(40), face(40)}});
  EXPECT_GT(compare(grid, sensor, poses, obstacles), 24U * 61U * 47U / 4);
}

// Cameras on faces, edges and corners of cells, where distances to cells jump, and in them.
TEST(Sweep, CamerasAmongTheCellsSeeTheSameBits) {
  constexpr int kEdge = 144;
  test::Random random(5);
  std::vector<Index3> unknown;
  for (int x = 1; x < kEdge; x += 8) {
    for (int y = 1; y < kEdge; y += 8) {
      for (int z = 1; z < kEdge; z += 8) {
        unknown.push_back({x + test::uniform_int(random, 0, 6), y + test::uniform_int(random, 0, 6),
                           z + test::uniform_int(random, 0, 6)});
      }
    }
  }
  const BeliefGrid grid = test::sparse_map({kEdge, kEdge, kEdge}, unknown, VoxelState::unknown);
  Sensor sensor = test::lattice_sensor(45, 33);
  sensor.camera.fx = sensor.camera.fy = 30;
  std::vector<Pose> poses;
  for (const int lattice : {8, 32, 128}) {
    for (int i = 0; i < 24; ++i) {
      Eigen::Vector3d at;
      for (int k = 0; k < 3; ++k) {
        at[k] = (i >> k & 1) != 0 ? test::uniform(random, 0, kEdge)
                                  : lattice * test::uniform_int(random, 0, kEdge / lattice);
      }
      Pose turned = test::random_rigid(random, 1);
      for (int k = 0; k < 3; ++k) {
        turned.m[static_cast<std::size_t>(4 * k + 3)] = at[k] * test::kExactVoxel;
      }
      poses.push_back(turned);
      poses.push_back(test::axis_pose(at, i % 3, i % 2 == 0));
    }
  }
  EXPECT_EQ(poses.size(), 144U);
  EXPECT_GT(compare(grid, sensor, poses), 20'000U);
}

}  // namespace
}  // namespace viewgain
