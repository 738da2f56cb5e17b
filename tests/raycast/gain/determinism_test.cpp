// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The same bits for any number of threads, run after run, after save and load, and across
// instruction sets.
#include <gtest/gtest.h>

#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

struct Made {
  test::RandomMap map;
  Sensor sensor;
  std::vector<Pose> poses;
};

Made make(std::uint64_t seed, test::MapFamily family, std::size_t poses = 40) {
  test::Random random(seed);
  test::RandomMap map = test::random_map(family, random);
  const Sensor sensor = test::random_sensor(map.grid, random);
  std::vector<Pose> views = test::random_poses(map, poses, random);
  return {std::move(map), sensor, std::move(views)};
}

constexpr std::array kFamilies{test::MapFamily::salt_and_pepper_30, test::MapFamily::tiles_8,
                               test::MapFamily::rotated};

TEST(Determinism, SameBitsForAnyNumberOfThreadsAndRunAfterRun) {
  std::size_t views = 0, gaining = 0;
  for (const test::MapFamily family : kFamilies) {
    const Made made = make(11, family);
    const auto scene = VoxelScene::build(made.map.grid);
    const std::vector<ViewGain> expected =
        GainEvaluator(scene, made.sensor, test::kPaper, {.num_threads = 1}).evaluate(made.poses);
    for (const int threads : {1, 2, 3, 8}) {
      const auto own_scene = VoxelScene::build(made.map.grid, {}, {.num_threads = threads});
      const GainEvaluator evaluator(own_scene, made.sensor, test::kPaper, {.num_threads = threads});
      EXPECT_EQ(evaluator.num_threads(), threads);
      for (int run = 0; run < 3; ++run) {
        const std::vector<ViewGain> actual = evaluator.evaluate(made.poses);
        EXPECT_TRUE(test::same_bits(expected, actual));
        views += actual.size();
        gaining += test::gaining(actual);
      }
    }
    // One by one as in a batch: the threads share each view.
    for (const int threads : {1, 2, 5}) {
      const GainEvaluator evaluator(scene, made.sensor, test::kPaper, {.num_threads = threads});
      for (std::size_t i = 0; i < made.poses.size(); ++i) {
        EXPECT_TRUE(test::same_bits(expected[i], evaluator.evaluate(made.poses[i])));
      }
    }
  }
  EXPECT_GT(gaining, views / 2);
}

// Of a view large enough that all threads have a part in it, its end included.
TEST(Determinism, OnePoseOnSeveralThreadsUnderEveryCriterionAndWeight) {
  int both_classes = 0;
  for (const test::MapFamily family : kFamilies) {
    Made made = make(13, family, 6);
    PinholeCamera& camera = made.sensor.camera;
    camera = {.width = 7 * camera.width,
              .height = 7 * camera.height,
              .fx = 7 * camera.fx,
              .fy = 7 * camera.fy,
              .cx = 7 * camera.cx,
              .cy = 7 * camera.cy};
    const auto scene = VoxelScene::build(made.map.grid);
    Box half = made.map.grid.workspace();
    half.max[0] = 0.5 * (half.min[0] + half.max[0]);
    for (const Criterion criterion :
         {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
      for (const bool is_weighted : {false, true}) {
        GainConfig config = test::by_paper(criterion);
        if (is_weighted) config.weights = {{half, 2.5}};
        const GainEvaluator alone(scene, made.sensor, config, {.num_threads = 1});
        const std::vector<ViewGain> expected = alone.evaluate(made.poses);
        for (const ViewGain& view : expected) {
          both_classes += view.unknown_voxels > 0 && view.occupied_voxels > 0 ? 1 : 0;
        }
        for (const int threads : {2, 5}) {
          const GainEvaluator together(scene, made.sensor, config, {.num_threads = threads});
          for (int run = 0; run < 4; ++run) {
            std::vector<ViewGain> actual;
            for (const Pose& pose : made.poses) actual.push_back(together.evaluate(pose));
            EXPECT_TRUE(test::same_bits(expected, actual));
          }
        }
      }
    }
  }
  EXPECT_GT(both_classes, 60);
}

TEST(Determinism, SameBitsAcrossInstructionSets) {
  for (const test::MapFamily family : kFamilies) {
    const Made made = make(13, family);
    std::vector<std::vector<ViewGain>> by_isa;
    for (const std::string& isa : available_isas()) {
      const test::ScopedIsa scoped(isa);
      const GainEvaluator evaluator(VoxelScene::build(made.map.grid), made.sensor, test::kPaper);
      EXPECT_EQ(evaluator.scene().isa(), isa);
      by_isa.push_back(evaluator.evaluate(made.poses));
      EXPECT_TRUE(test::same_bits(by_isa.front(), by_isa.back())) << isa;
      EXPECT_GT(test::gaining(by_isa.back()), made.poses.size() / 2) << isa;
    }
  }
}

TEST(Determinism, SceneOutlivesTheGridAndIgnoresItsChanges) {
  Made made = make(14, test::MapFamily::salt_and_pepper_1);
  const GainEvaluator evaluator(VoxelScene::build(made.map.grid), made.sensor, test::kPaper);
  const std::vector<ViewGain> expected = evaluator.evaluate(made.poses);
  const Index3 min = made.map.grid.min_index();
  const Index3 dims = made.map.grid.dims();
  for (int x = 0; x < dims.x; ++x) {
    for (int y = 0; y < dims.y; ++y) {
      made.map.grid.set({min.x + x, min.y + y, min.z + dims.z / 2}, 0.85F);
    }
  }
  EXPECT_TRUE(test::same_bits(expected, evaluator.evaluate(made.poses)));
  const GainEvaluator changed(VoxelScene::build(made.map.grid), made.sensor, test::kPaper);
  EXPECT_FALSE(test::same_bits(expected, changed.evaluate(made.poses)));
  made.map.grid = test::sparse_map({4, 4, 4}, {});
  EXPECT_TRUE(test::same_bits(expected, evaluator.evaluate(made.poses)));
}

}  // namespace
}  // namespace viewgain
