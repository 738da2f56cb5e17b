// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// An evaluator that follows a map: with_scene() gives what an evaluator made for the scene gives.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "raycast/scene_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr std::array kCriteria{Criterion::log_diagonal, Criterion::log_determinant,
                               Criterion::trace};

// Everything that the two say of the poses; returns how many rays that are.
std::size_t expect_same(const GainEvaluator& followed, const GainEvaluator& fresh,
                        const std::vector<Pose>& poses) {
  EXPECT_EQ(followed.prior_sigma(), fresh.prior_sigma());
  EXPECT_TRUE(test::same_bits(followed.evaluate(poses), fresh.evaluate(poses)));
  std::vector<ApproximateGain> a(poses.size()), b(poses.size());
  followed.approximate(poses, a);
  fresh.approximate(poses, b);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE(test::same_bits(followed.evaluate(poses[i]), fresh.evaluate(poses[i])));
    EXPECT_EQ(std::isnan(a[i].gain), std::isnan(b[i].gain));
    if (!std::isnan(a[i].gain)) {
      EXPECT_EQ(a[i].gain, b[i].gain);
    }
    const std::vector<RayHit> x = followed.trace(poses[i]), y = fresh.trace(poses[i]);
    EXPECT_EQ(x.size(), y.size());
    for (std::size_t r = 0; r < x.size(); ++r) {
      EXPECT_EQ(x[r].kind, y[r].kind);
      EXPECT_EQ(x[r].voxel, y[r].voxel);
      EXPECT_EQ(x[r].range, y[r].range);
    }
    rays += x.size();
  }
  EXPECT_EQ(followed.best_set(poses, 3).indices, fresh.best_set(poses, 3).indices);
  return rays;
}

TEST(WithScene, HasTheBitsOfAFreshEvaluatorWhateverTheScenes) {
  std::size_t rays = 0;
  for (const Criterion criterion : kCriteria) {
    for (const int variant : {0, 1, 2, 3}) {  // plain, weights, distortion, several threads
      test::Random random(10 * static_cast<std::uint64_t>(criterion) +
                          static_cast<std::uint64_t>(variant));
      GainConfig config = test::by_paper(criterion);
      if (variant == 1) config.weights = {{{{-9, -9, -9}, {0.1, 9, 9}}, 3.0}};
      const ExecConfig exec{.num_threads = variant == 3 ? 3 : 1};
      std::optional<Sensor> sensor;
      std::optional<GainEvaluator> evaluator;
      std::shared_ptr<const VoxelScene> first;
      std::vector<Pose> first_poses;
      // Maps of other sizes, with larger boxes and without, and obstacles that come and go.
      for (const test::MapFamily family :
           {test::MapFamily::salt_and_pepper_1, test::MapFamily::tiles_128,
            test::MapFamily::salt_and_pepper_30, test::MapFamily::rotated}) {
        const test::RandomMap map = test::random_map(family, random);
        if (!sensor) {
          sensor = test::random_sensor(map.grid, random);
          sensor->camera.distortion = {};
          if (variant == 2) sensor->camera.distortion = {-0.05, 0.01, 1e-3, -1e-3, 0};
        }
        Obstacles obstacles;
        if (family == test::MapFamily::salt_and_pepper_30) obstacles.boxes.push_back(map.room);
        const auto scene = VoxelScene::build(map.grid, {obstacles});
        const std::vector<Pose> poses = test::random_poses(map, 12, random);
        if (evaluator) {
          evaluator = evaluator->with_scene(scene);
        } else {
          evaluator.emplace(scene, *sensor, config, exec);
          first = scene, first_poses = poses;
        }
        rays += expect_same(*evaluator, GainEvaluator(scene, *sensor, config, exec), poses);
        // And back, with the workspaces that the larger scene has left.
        rays += expect_same(evaluator->with_scene(first),
                            GainEvaluator(first, *sensor, config, exec), first_poses);
      }
    }
  }
  EXPECT_GT(rays, 100'000U);
}

TEST(WithScene, ThePriorFollowsTheMapUnlessItIsGiven) {
  const auto scene_of = [](double prior_sigma) {
    return VoxelScene::build(BeliefGrid({.voxel_size = 0.01,
                                         .workspace = {{0, 0, 0}, {0.1, 0.1, 0.1}},
                                         .prior_sigma = prior_sigma}));
  };
  const GainEvaluator follows(scene_of(0.02), sensor_preset("sr4000"));
  EXPECT_EQ(follows.with_scene(scene_of(0.03)).prior_sigma(), 0.03);
  const GainEvaluator given(scene_of(0.02), sensor_preset("sr4000"), {.prior_sigma = 0.05});
  EXPECT_EQ(given.with_scene(scene_of(0.03)).prior_sigma(), 0.05);
}

// What takes long is made once: a sensor's rays, of which the camera is a part, and the threads.
TEST(WithScene, SharesTheRaysAndRefusesNoScene) {
  test::Random random(7);
  const test::RandomMap map = test::random_map(test::MapFamily::salt_and_pepper_1, random);
  const auto scene = VoxelScene::build(map.grid);
  const GainEvaluator evaluator(scene, sensor_preset("kinect_v1"), {.pixel_stride = 2},
                                {.num_threads = 3});
  const GainEvaluator next = evaluator.with_scene(scene);
  EXPECT_EQ(&next.camera(), &evaluator.camera());
  EXPECT_EQ(next.num_threads(), 3);
  EXPECT_EQ(next.pixel_stride(), 2);
  EXPECT_EQ(&next.scene(), scene.get());
  EXPECT_THROW((void)evaluator.with_scene(nullptr), Error);
}

}  // namespace
}  // namespace viewgain
