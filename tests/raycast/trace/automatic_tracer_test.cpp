// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// When ExecConfig::Tracer::automatic takes Embree.
#include <gtest/gtest.h>

#include "raycast/scene_makers.hpp"
#include "trace/tracer_rule.hpp"

namespace viewgain {
namespace {

TEST(AutomaticTracer, TheRuleHasTwoSides) {
  using detail::bvh_is_faster;
  using detail::bvh_pays;
  // An object, a room and a sparse hall, as perf/results/tracers.md measures them.
  static_assert(bvh_is_faster(64, 802) && !bvh_is_faster(396, 802));
  static_assert(bvh_is_faster(64, 13'127) && !bvh_is_faster(396, 13'127));
  static_assert(bvh_is_faster(396, 85'156) && !bvh_is_faster(25'344, 85'156));
  for (const std::size_t primitives : {802U, 13'127U, 85'156U}) {
    EXPECT_FALSE(bvh_pays(primitives, 0));
    EXPECT_FALSE(bvh_pays(primitives, primitives / 5 - 1));
    EXPECT_TRUE(bvh_pays(primitives, primitives / 5));
  }
}

// Small images, so many that a BVH pays on the way; several threads are in the middle of views
// then.
TEST(AutomaticTracer, ChangesOverWithoutATrace) {
  std::size_t views = 0, gaining = 0;
  for (const int threads : {1, 4}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      test::Random random(300 + seed);
      const test::RandomMap map = test::random_map(test::MapFamily::salt_and_pepper_1, random);
      const Sensor sensor = test::random_sensor(map.grid, random);
      const auto scene = VoxelScene::build(map.grid);
      const std::vector<Pose> poses = test::random_poses(map, 40, random);
      for (const GainModel model : {GainModel::paper, GainModel::combined}) {
        const GainConfig config{.model = model, .pixel_stride = 3};
        const GainEvaluator swept(scene, sensor, config, {1, ExecConfig::Tracer::sweep});
        ASSERT_LT(swept.rays_per_pose(), 100U);
        const std::vector<ViewGain> expected = swept.evaluate(poses);
        const GainEvaluator chosen(VoxelScene::build(map.grid), sensor, config, {threads});
        const std::size_t pays = scene->primitive_count() / 5;
        for (std::size_t seen = 0; seen < pays + 3 * poses.size(); seen += poses.size()) {
          EXPECT_TRUE(test::same_bits(expected, chosen.evaluate(poses)));
          views += poses.size();
        }
        gaining += test::gaining(expected);
      }
    }
  }
  EXPECT_GT(views, 2000U);
  EXPECT_GT(gaining, 200U);
}

}  // namespace
}  // namespace viewgain
