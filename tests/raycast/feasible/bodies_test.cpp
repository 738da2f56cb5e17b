// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Bodies in maps of many regions, and in closed meshes of many triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "raycast/scene_makers.hpp"
#include "solids.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {
namespace {

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
      std::array<int, 6> box{std::max(low.x, min.x),           std::max(low.y, min.y),
                             std::max(low.z, min.z),           std::min(high.x, min.x + dims.x),
                             std::min(high.y, min.y + dims.y), std::min(high.z, min.z + dims.z)};
      for (int x = box[0]; x < box[3]; ++x) {
        for (int y = box[1]; y < box[4]; ++y) {
          for (int z = box[2]; z < box[5]; ++z) {
            states[static_cast<std::size_t>(((x - min.x) * dims.y + y - min.y) * dims.z + z -
                                            min.z)] = 0;
          }
        }
      }
      if (box[0] < box[3] && box[1] < box[4] && box[2] < box[5]) {
        add({box[0] * 1.0, box[1] * 1.0, box[2] * 1.0}, {box[3] * 1.0, box[4] * 1.0, box[5] * 1.0});
      }
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
