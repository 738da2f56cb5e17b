// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What may run at once, at once: each thread's answers are those of a thread alone.
// `tests/nightly.sh tsan` looks for races in them.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "grid/analytic_frames.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain {
namespace {

constexpr int kRounds = 4;

/// Starts threads that run work(0), work(1), ... at once and waits for them.
void at_once(std::size_t threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> waiting{threads};
  std::vector<std::jthread> running;
  for (std::size_t i = 0; i < threads; ++i) {
    running.emplace_back([&, i] {
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      work(i);
    });
  }
}

class Concurrency : public testing::Test {
 protected:
  Concurrency()
      : sensor_(test::small_sensor(48, 36)), grid_(test::object_grid(48)), integrator_(sensor_) {
    sensor_.camera.distortion = {};
    see(0);
    see(1);
    for (int i = 0; i < 24; ++i) poses_.push_back(test::ring_view(3 * i));
  }

  void see(int view) {
    const Pose pose = test::ring_view(view);
    integrator_.integrate(grid_, test::see_spheres(sensor_, pose, test::three_spheres_in_a_room()),
                          pose);
  }

  [[nodiscard]] std::vector<ViewGain> gains(const std::shared_ptr<const VoxelScene>& scene) const {
    return GainEvaluator(scene, sensor_, test::kPaper, {.num_threads = 1}).evaluate(poses_);
  }

  Sensor sensor_;
  BeliefGrid grid_;
  FrameIntegrator integrator_;
  std::vector<Pose> poses_;
};

TEST_F(Concurrency, AMapIsWrittenWhileItsSnapshotIsEvaluated) {
  int same = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto scene = VoxelScene::build(grid_);
    const std::vector<ViewGain> expected = gains(scene);
    const GainEvaluator evaluator(scene, sensor_, test::kPaper, {.num_threads = 2});
    at_once(3, [&](std::size_t number) {
      if (number == 0) {
        see(2 + round);
        grid_.set({0, 0, 0}, 0.85F, Belief{{1e4F, 1e4F, 1e4F, 0, 0, 0}, {}, 1});
      } else if (test::same_bits(evaluator.evaluate(poses_), expected)) {
        ++std::atomic_ref(same);
      }
    });
    EXPECT_FALSE(test::same_bits(gains(VoxelScene::build(grid_)), expected));
  }
  EXPECT_EQ(same, 2 * kRounds);
}

TEST_F(Concurrency, TenThousandCallsWhileFramesComeAreThoseOfOneThread) {
  constexpr std::size_t kThreads = 8, kCalls = (test::kSlowBuild ? 400 : 10'000) / kThreads,
                        kScenes = 12;
  struct Call {
    std::size_t scene, pose;
    double gain;
  };
  std::vector<std::shared_ptr<const VoxelScene>> scenes{VoxelScene::build(grid_)};
  auto current = std::make_shared<const GainEvaluator>(scenes[0], sensor_, test::kPaper,
                                                       ExecConfig{.num_threads = 2});
  std::mutex mutex;  // of these two
  std::vector<std::vector<Call>> made(kThreads);
  at_once(kThreads + 1, [&](std::size_t number) {
    if (number == kThreads) {
      for (int view = 2; view <= static_cast<int>(kScenes); ++view) {
        see(view);
        const auto next = VoxelScene::update(scenes.back(), grid_, {.num_threads = 1});
        const auto following = std::make_shared<const GainEvaluator>(current->with_scene(next));
        const std::lock_guard lock(mutex);
        scenes.push_back(next);
        current = following;
      }
      return;
    }
    for (std::size_t i = 0; i < kCalls; ++i) {
      std::shared_ptr<const GainEvaluator> evaluator;
      std::size_t scene = 0;
      {
        const std::lock_guard lock(mutex);
        evaluator = current;
        scene = scenes.size() - 1;
      }
      const std::size_t pose = (7 * number + i) % poses_.size();
      made[number].push_back({scene, pose, evaluator->evaluate(poses_[pose]).gain});
    }
  });
  ASSERT_EQ(scenes.size(), kScenes);
  std::vector<std::vector<ViewGain>> expected;
  for (const auto& scene : scenes) expected.push_back(gains(scene));
  std::size_t same = 0;
  for (const std::vector<Call>& calls : made) {
    for (const Call& call : calls)
      same += call.gain == expected[call.scene][call.pose].gain ? 1 : 0;
  }
  EXPECT_EQ(same, kThreads * kCalls);
}

TEST_F(Concurrency, TheFirstToNeedTheBvhMakesItForAll) {
  const auto expected =
      GainEvaluator(VoxelScene::build(grid_), sensor_, test::kPaper, {.num_threads = 1})
          .evaluate(poses_);
  int same = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto scene = VoxelScene::build(grid_, {}, {.num_threads = 1});
    at_once(4, [&](std::size_t) {
      const GainEvaluator evaluator(scene, sensor_, test::kPaper, {1, ExecConfig::Tracer::embree});
      if (test::same_bits(evaluator.evaluate(poses_), expected)) ++std::atomic_ref(same);
    });
  }
  EXPECT_EQ(same, 4 * kRounds);
}

TEST_F(Concurrency, OneEvaluatorAnswersAllKindsOfQuestions) {
  const GainEvaluator evaluator(VoxelScene::build(grid_), sensor_, test::kPaper,
                                {.num_threads = 3});
  const std::vector<ViewGain> expected = evaluator.evaluate(poses_);
  const std::vector<std::size_t> best = best_indices(expected, 3);
  const ViewSet set = evaluator.best_set(poses_, 2);
  std::vector<ApproximateGain> approximate(poses_.size());
  evaluator.approximate(poses_, approximate);
  std::atomic<int> right{0};
  at_once(8, [&](std::size_t number) {
    for (int round = 0; round < kRounds; ++round) {
      bool is_right = false;
      switch (number % 8) {
        case 0:
          is_right = test::same_bits(evaluator.evaluate(poses_), expected);
          break;
        case 1:
        case 2:  // one view on all threads, by two callers
          is_right = true;
          for (std::size_t i = 0; i < poses_.size(); ++i) {
            is_right = is_right && test::same_bits(evaluator.evaluate(poses_[i]), expected[i]);
          }
          break;
        case 3:
          is_right = evaluator.best(poses_, 3).indices == best;
          break;
        case 4:
          is_right = evaluator.race(poses_, 1).indices.front() == best.front();
          break;
        case 5:
          is_right = evaluator.best_set(poses_, 2).indices == set.indices;
          break;
        case 6: {
          std::vector<ApproximateGain> own(poses_.size());
          evaluator.approximate(poses_, own);
          is_right = true;
          for (std::size_t i = 0; i < own.size(); ++i) {
            is_right = is_right && own[i].gain == approximate[i].gain;
          }
          break;
        }
        default:
          is_right = evaluator.trace(poses_[0]).size() == evaluator.rays_per_pose() &&
                     evaluator.contributions(poses_[0]).size() ==
                         expected[0].unknown_voxels + expected[0].occupied_voxels;
      }
      right += is_right ? 1 : 0;
    }
  });
  EXPECT_EQ(right, 8 * kRounds);
}

TEST_F(Concurrency, ACheckerIsAskedWhileItsMapGrows) {
  FeasibilityConfig config;
  config.body.size = {0.01, 0.01, 0.01};
  config.sensor = sensor_;
  auto scene = VoxelScene::build(grid_, {{{{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}}, {}}});
  std::vector<Pose> poses;
  for (const Pose& pose : poses_) {
    for (const double share : {0.25, 0.5, 0.9}) {
      poses.push_back({pose.rotation(), share * pose.translation()});
    }
  }
  std::atomic<int> right{0};
  FeasibilityChecker checker(scene, config, {.num_threads = 2});
  for (int round = 0; round < kRounds; ++round) {
    const auto expected = FeasibilityChecker(scene, config, {.num_threads = 1}).check(poses);
    std::shared_ptr<const VoxelScene> next;
    at_once(4, [&](std::size_t number) {
      if (number == 0) {
        see(2 + round);
        next = VoxelScene::update(scene, grid_, {.num_threads = 1});
        (void)checker.with_scene(next);
      } else if (number == 1) {
        bool is_right = true;
        for (std::size_t i = 0; i < poses.size(); ++i) {
          is_right = is_right && checker.check(poses[i]) == expected[i];
        }
        right += is_right ? 1 : 0;
      } else {
        right += checker.check(poses) == expected ? 1 : 0;
      }
    });
    scene = next;
    checker = checker.with_scene(scene);
  }
  EXPECT_EQ(right, 3 * kRounds);
}

}  // namespace
}  // namespace viewgain
