// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The evaluator's other calls with the surface and the combined gain.
#include <gtest/gtest.h>

#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

constexpr std::array kModels{GainModel::surface, GainModel::combined};

class SurfaceCalls : public testing::TestWithParam<GainModel> {
 protected:
  test::Random random_{17};
  test::RandomMap made_ = test::random_map(test::MapFamily::tiles_8, random_);
  Sensor sensor_ = test::random_sensor(made_.grid, random_);
  std::vector<Pose> poses_ = test::random_poses(made_, 60, random_);
  std::shared_ptr<const VoxelScene> scene_ = VoxelScene::build(made_.grid);
};

TEST_P(SurfaceCalls, ContributionsAddUpToTheGain) {
  const GainEvaluator evaluator(scene_, sensor_, {.model = GetParam()});
  std::size_t views = 0, known = 0;
  for (const Pose& pose : poses_) {
    const ViewGain gain = evaluator.evaluate(pose);
    const std::vector<VoxelContribution> parts = evaluator.contributions(pose);
    if (gain.status != ViewGain::Status::ok) {
      EXPECT_TRUE(parts.empty());
      continue;
    }
    double sum = 0, expected_rays = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const VoxelContribution& part = parts[i];
      EXPECT_EQ(made_.grid.state(part.voxel), part.state);
      EXPECT_GE(part.rays, 1U);
      EXPECT_LE(part.expected_rays, part.rays * (1 + 1e-6));
      EXPECT_LE(part.gain, parts[i == 0 ? 0 : i - 1].gain);
      sum += part.gain;
      expected_rays += part.expected_rays;
      known += part.state == VoxelState::occupied ? 1 : 0;
    }
    EXPECT_NEAR(sum, gain.gain, 1e-5 * gain.gain);
    EXPECT_LE(expected_rays, gain.rays * (1 + 1e-6));
    views += gain.gain > 0 ? 1 : 0;
  }
  EXPECT_GT(views, 20U);
  EXPECT_EQ(known > 0, GetParam() == GainModel::combined);
}

TEST_P(SurfaceCalls, AnUpdatedSceneKeepsItsHazard) {
  const HazardConfig hazard{.object_size = 0.5};
  const auto before = VoxelScene::build(made_.grid, {}, {}, hazard);
  BeliefGrid grid = made_.grid.clone();
  for (int i = 0; i < 40; ++i) {
    const Index3& base = grid.min_index();
    grid.set({base.x + i % 7, base.y + 3, base.z + i % 16}, i % 2 == 0 ? -1.0F : 1.0F);
  }
  const auto updated = VoxelScene::update(before, grid);
  const auto fresh = VoxelScene::build(grid, {}, {}, hazard);
  const GainEvaluator evaluator(before, sensor_, {.model = GetParam()});
  EXPECT_TRUE(
      test::same_bits(evaluator.with_scene(updated).evaluate(poses_),
                      GainEvaluator(fresh, sensor_, {.model = GetParam()}).evaluate(poses_)));
  EXPECT_FALSE(test::same_bits(
      evaluator.with_scene(updated).evaluate(poses_),
      GainEvaluator(VoxelScene::build(grid), sensor_, {.model = GetParam()}).evaluate(poses_)));
}

std::string model_name(const testing::TestParamInfo<GainModel>& info) {
  return std::string(gain_model_name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Models, SurfaceCalls, testing::ValuesIn(kModels), model_name);

}  // namespace
}  // namespace viewgain
