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
  struct Case {
    std::size_t primitives, most_rays, views;
  };
  for (const auto& [primitives, most_rays, views] :
       {Case{802, 100, 160}, Case{13'127, 262, 2625}, Case{85'156, 1703, 3000}}) {
    EXPECT_TRUE(bvh_is_faster(most_rays, primitives));
    EXPECT_FALSE(bvh_is_faster(most_rays + 1, primitives));
    EXPECT_FALSE(bvh_pays(primitives, views - 1));
    EXPECT_TRUE(bvh_pays(primitives, views));
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
