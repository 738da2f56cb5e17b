// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Contributions by voxel against the oracle's gain of the rays that end there.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "oracle/gain.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

constexpr std::uint64_t kSeeds = test::kSlowBuild ? 1 : 6;

bool comes_before(const VoxelContribution& a, const VoxelContribution& b) {
  if (a.gain != b.gain) return a.gain > b.gain;
  return std::tuple(a.voxel.x, a.voxel.y, a.voxel.z) < std::tuple(b.voxel.x, b.voxel.y, b.voxel.z);
}

/// The hits that end in one voxel; the others end nowhere.
std::vector<RayHit> those_in(const std::vector<RayHit>& hits, Index3 voxel) {
  std::vector<RayHit> own(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const bool gains =
        hits[i].kind == RayHit::Kind::unknown || hits[i].kind == RayHit::Kind::occupied;
    if (gains && hits[i].voxel == voxel) own[i] = hits[i];
  }
  return own;
}

TEST(ViewContributions, AreTheOraclesGainsOfSingleVoxelsAndAddUp) {
  std::uint64_t views = 0, voxels = 0, occupied = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const test::MapFamily family :
         {test::MapFamily::salt_and_pepper_1, test::MapFamily::salt_and_pepper_30,
          test::MapFamily::tiles_8, test::MapFamily::tiles_128, test::MapFamily::rotated}) {
      test::Random random(900 + seed);
      const test::RandomMap map = test::random_map(family, random);
      const Sensor sensor = test::random_sensor(map.grid, random);
      Box half = map.grid.workspace();
      half.max[0] = 0.5 * (half.min[0] + half.max[0]);
      const auto scene = VoxelScene::build(map.grid);
      for (const Criterion criterion :
           {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
        GainConfig config = test::by_paper(criterion);
        if (criterion == Criterion::log_determinant) config.weights = {{half, 2.5}};
        const GainEvaluator evaluator(scene, sensor, config, {.num_threads = 1});
        for (const Pose& pose : test::random_poses(map, 4, random)) {
          const ViewGain whole = evaluator.evaluate(pose);
          const std::vector<VoxelContribution> parts = evaluator.contributions(pose);
          const std::vector<RayHit> hits = evaluator.trace(pose);
          ++views;
          EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end(), comes_before));
          double sum = 0;
          std::uint32_t rays = 0, unknown = 0;
          for (const VoxelContribution& part : parts) {
            sum += part.gain;
            rays += part.rays;
            if (part.state == VoxelState::unknown) ++unknown;
          }
          EXPECT_NEAR(sum, whole.gain, 1e-9 * whole.gain);
          EXPECT_EQ(rays, whole.hits);
          EXPECT_EQ(unknown, whole.unknown_voxels);
          EXPECT_EQ(parts.size() - unknown, whole.occupied_voxels);
          // The largest and some of the rest: the oracle's own cost is a view each.
          for (std::size_t i = 0; i < parts.size(); i += 1 + i / 8) {
            const VoxelContribution& part = parts[i];
            const ViewGain expected =
                oracle::gain_of_hits(map.grid, sensor, config, pose, those_in(hits, part.voxel));
            EXPECT_NEAR(part.gain, expected.gain, 1e-6 * expected.gain);
            EXPECT_EQ(part.rays, expected.hits);
            EXPECT_EQ(part.state, map.grid.state(part.voxel));
            EXPECT_EQ(expected.occupied_voxels, part.state == VoxelState::occupied ? 1U : 0U);
            ++voxels;
            occupied += expected.occupied_voxels;
          }
        }
      }
    }
  }
  EXPECT_EQ(views, kSeeds * 5 * 3 * 4);
  EXPECT_GT(voxels, kSeeds * 400);
  EXPECT_GT(occupied, kSeeds * 50);
}

TEST(ViewContributions, NoneForABadPoseOrACameraInAnOccupiedVoxel) {
  const BeliefGrid grid = test::sparse_map({16, 16, 16}, {{4, 4, 4}, {4, 4, 9}});
  const GainEvaluator evaluator(VoxelScene::build(grid), test::lattice_sensor(3, 3), test::kPaper);
  Pose pose = test::axis_pose({4.5, 4.5, 6.5}, 2, true);
  EXPECT_EQ(evaluator.contributions(pose).size(), 1U);
  EXPECT_TRUE(evaluator.contributions(test::axis_pose({4.5, 4.5, 4.5}, 2, true)).empty());
  pose.m[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(evaluator.contributions(pose).empty());
}

}  // namespace
}  // namespace viewgain
