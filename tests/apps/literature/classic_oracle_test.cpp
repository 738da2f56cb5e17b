// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// All classic gains of random maps against slow sums over an octomap::OcTree, under
// each instruction set.
#include <gtest/gtest.h>

#include <cmath>

#include "apps/literature/classic_makers.hpp"
#include "apps/literature/octomap_oracle.hpp"
#include "grid/voxels.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using test::MapFamily;

constexpr int kMaps = test::kSlowBuild ? 6 : 24;
constexpr std::size_t kPosesPerMap = 3;
constexpr double kTolerance = 1e-5;
constexpr double kRounding = 1e-13;  // area_factor is a difference of numbers about 1
// Rays are in single precision: here and there one goes by the other side of a voxel's edge, or the
// faces of a sliver of unknown space are a little off.
constexpr double kMostExceptions = 0.01, kLargestException = 1e-3;

/// Unknown voxels near occupied ones.
bool needs_neighbours(std::size_t gain) {
  const auto named = static_cast<ClassicGain>(gain);
  return named == ClassicGain::proximity_count || named == ClassicGain::surface_frontier_count ||
         named == ClassicGain::rear_side_voxel || named == ClassicGain::rear_side_entropy;
}

class ClassicOracle : public testing::TestWithParam<MapFamily> {};

TEST_P(ClassicOracle, AllGainsAgreeUnderEachInstructionSet) {
  test::Random random(977 + static_cast<unsigned>(GetParam()));
  const std::vector<std::string> isas = available_isas();
  std::size_t checks = 0, exceptions = 0;
  std::array<std::size_t, 10> above_zero{};
  for (int i = 0; i < kMaps; ++i) {
    test::RandomMap made = test::random_map(GetParam(), random);
    test::vary_log_odds(made.grid, random);
    const Sensor sensor = test::random_sensor(made.grid, random);
    for (const Pose& view : test::random_poses(made, 3, random)) made.grid.append_view(view);
    Surroundings around;
    if (i % 4 == 3) around.obstacles = test::random_boxes(made.grid, random);
    Acquisition acquisition{sensor, 12.3 * made.grid.voxel_size()};
    acquisition.sensor.min_range = 0;
    ClassicConfig config;
    config.gains = test::all_classic_gains();
    config.pixel_stride = 1 + i % 3;
    if (i % 5 == 1) config.min_range = 0;
    if (i % 5 == 2) config.unknown_prior = 0.35;
    if (i % 4 == 2) {
      // Between planes of the lattice, which would be ties.
      const Index3 low = made.grid.min_index();
      around.support_plane =
          (made.grid.T_world_grid() * voxel_center(low, made.grid.voxel_size())).z() +
          1.7 * made.grid.voxel_size();
    }
    const test::OctomapOracle oracle(made.grid, around, acquisition);
    const std::vector<Pose> poses = test::random_poses(made, kPosesPerMap, random);
    std::vector<std::array<double, 10>> expected;
    for (const Pose& pose : poses) expected.push_back(oracle.gains(sensor, config, pose));
    for (const std::string& isa : isas) {
      const test::ScopedIsa scoped(isa);
      const auto scene = VoxelScene::build(made.grid, around, {.num_threads = 1});
      const auto map = ClassicMap::build(scene, made.grid, acquisition, {.num_threads = 1});
      const std::vector<double> actual =
          ClassicGainEvaluator(map, sensor, config, {.num_threads = 1}).evaluate(poses);
      for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        for (std::size_t g = 0; g < 10; ++g) {
          const double want = expected[pose][g], have = actual[pose * 10 + g];
          const double off = std::abs(have - want), size = std::abs(want);
          exceptions += off > kTolerance * size + kRounding ? 1 : 0;
          EXPECT_LE(off, kLargestException * size + kRounding)
              << "map " << i << ", pose " << pose << ", " << isa << ", " << classic_gain_names()[g];
          above_zero[g] += want > 0 ? 1 : 0;
          ++checks;
        }
      }
    }
  }
  EXPECT_EQ(checks, kMaps * kPosesPerMap * isas.size() * 10);
  EXPECT_LE(static_cast<double>(exceptions), kMostExceptions * static_cast<double>(checks));
  for (std::size_t g = 0; g < 10; ++g) {
    // In maps with next to nothing unknown or occupied these need not meet.
    if (GetParam() == MapFamily::salt_and_pepper_01 && needs_neighbours(g)) continue;
    EXPECT_GE(above_zero[g], isas.size() * (test::kSlowBuild ? 1 : 2)) << classic_gain_names()[g];
  }
}

TEST_P(ClassicOracle, FrontiersAndOcclusionAreTheSameVoxels) {
  test::Random random(31 + static_cast<unsigned>(GetParam()));
  std::size_t frontiers = 0, hidden = 0, voxels = 0;
  for (int i = 0; i < 3; ++i) {
    test::RandomMap made = test::random_map(GetParam(), random);
    const Sensor sensor = test::random_sensor(made.grid, random);
    for (const Pose& view : test::random_poses(made, 4, random)) made.grid.append_view(view);
    const Acquisition acquisition{sensor, 9 * made.grid.voxel_size()};
    const test::OctomapOracle oracle(made.grid, {}, acquisition);
    const auto map = ClassicMap::build(VoxelScene::build(made.grid), made.grid, acquisition);
    const auto [x0, y0, z0] = made.grid.min_index();
    const Index3 dims = made.grid.dims();
    // One voxel beyond the workspace at each side, which is none of either.
    std::size_t wrong = 0;
    const VoxelBox wider =
        VoxelBox::from_dims({x0 - 1, y0 - 1, z0 - 1}, {dims.x + 2, dims.y + 2, dims.z + 2});
    test::for_each_voxel(wider, [&](Index3 voxel) {
      ++voxels;
      wrong += map->occlusion_steps(voxel) != oracle.occlusion_steps(voxel) ? 1 : 0;
      hidden += map->occlusion_steps(voxel) > 0 ? 1 : 0;
      // The 26 neighbours one by one take long: every voxel near the last is enough.
      if ((voxel.x ^ voxel.y ^ voxel.z) % 3 != 0) return;
      wrong += map->is_surface_frontier(voxel) != oracle.is_surface_frontier(voxel) ? 1 : 0;
      frontiers += map->is_surface_frontier(voxel) ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0U);
  }
  EXPECT_GT(voxels, 3U * 20 * 20 * 20);
  EXPECT_GT(frontiers, 0U);
  EXPECT_GT(hidden, 0U);
}

INSTANTIATE_TEST_SUITE_P(Maps, ClassicOracle,
                         testing::Values(MapFamily::salt_and_pepper_01,
                                         MapFamily::salt_and_pepper_1,
                                         MapFamily::salt_and_pepper_30, MapFamily::tiles_8,
                                         MapFamily::odd_and_far, MapFamily::rotated),
                         test::family_name);

}  // namespace
}  // namespace viewgain
