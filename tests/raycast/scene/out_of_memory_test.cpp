// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Scenes and views while memory runs out: a call gives the right answer or throws, and what there
// was before goes on working. A program of its own, since it replaces operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <optional>
#include <vector>

#include "core/replaced_new.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/error.hpp"

namespace {

/// Allocations until they fail; negative: none does.
std::atomic<long> allocations_left{-1};
std::atomic<bool> fails_once{true};  ///< else all fail from then on
std::atomic<long> failures{0};

}  // namespace

void on_allocation(std::size_t /*size*/) {
  if (allocations_left.load() >= 0 && allocations_left.fetch_sub(1) <= 0) {
    if (!fails_once) allocations_left = 0;
    ++failures;
    throw std::bad_alloc();
  }
}

// Embree forgets what it has of a scene or device whose making fails.
extern "C" const char* __lsan_default_suppressions() { return "leak:libembree"; }

namespace viewgain {
namespace {

/// Runs `call` with memory for more and more allocations, until there is enough; returns how often
/// it threw. `after` is called then.
template <typename Call, typename After>
int runs_that_threw(const Call& call, const After& after) {
  int threw = 0;
  for (const bool once : {true, false}) {
    fails_once = once;
    for (long count = 0;; count += 1 + count / 10) {
      failures = 0;
      allocations_left = count;
      bool has_answered = true;
      try {
        call();
      } catch (const std::bad_alloc&) {
        has_answered = false;
      } catch (const Error& error) {
        has_answered = false;
        EXPECT_NE(error.code(), ErrorCode::invalid_argument) << error.what();
      }
      allocations_left = -1;
      if (has_answered && failures == 0) break;
      threw += has_answered ? 0 : 1;
      after();
    }
  }
  return threw;
}

class OutOfMemory : public testing::Test {
 protected:
  OutOfMemory()
      : random_(9),
        map_(test::random_map(test::MapFamily::salt_and_pepper_30, random_)),
        sensor_(test::random_sensor(map_.grid, random_)),
        poses_(test::random_poses(map_, 24, random_)) {
    sensor_.camera.distortion = {};
    obstacles_.boxes.push_back({{-0.1, -0.1, -0.1}, {0.05, 0.05, 0.05}});
  }

  [[nodiscard]] std::vector<ViewGain> gains(const std::shared_ptr<const VoxelScene>& scene) const {
    return GainEvaluator(scene, sensor_, test::kPaper, {.num_threads = 2}).evaluate(poses_);
  }

  test::Random random_;
  test::RandomMap map_;
  Sensor sensor_;
  std::vector<Pose> poses_;
  Obstacles obstacles_;
};

TEST_F(OutOfMemory, AScene) {
  for (const bool has_obstacles : {false, true}) {
    const Obstacles obstacles = has_obstacles ? obstacles_ : Obstacles{};
    const std::vector<ViewGain> expected = gains(VoxelScene::build(map_.grid, {obstacles}));
    std::shared_ptr<const VoxelScene> scene;
    const int threw = runs_that_threw(
        [&] {
          scene = nullptr;
          scene = VoxelScene::build(map_.grid, {obstacles}, {.num_threads = 1});
        },
        [&] { EXPECT_TRUE(scene == nullptr || test::same_bits(gains(scene), expected)); });
    EXPECT_GT(threw, 20) << has_obstacles;
    EXPECT_TRUE(test::same_bits(gains(scene), expected));
  }
}

TEST_F(OutOfMemory, AnUpdate) {
  const auto before = VoxelScene::build(map_.grid);
  const std::vector<ViewGain> old = gains(before);
  const Index3 low = map_.grid.min_index();
  for (int i = 0; i < 8; ++i) map_.grid.set({low.x + i, low.y + 4, low.z + 4}, 0.85F);
  const std::vector<ViewGain> expected = gains(VoxelScene::build(map_.grid));
  std::shared_ptr<const VoxelScene> scene;
  const int threw = runs_that_threw(
      [&] {
        scene = nullptr;
        scene = VoxelScene::update(before, map_.grid, {.num_threads = 1});
      },
      [&] {
        EXPECT_TRUE(scene == nullptr || test::same_bits(gains(scene), expected));
        EXPECT_TRUE(test::same_bits(gains(before), old));
      });
  EXPECT_GT(threw, 15);
  EXPECT_TRUE(test::same_bits(gains(scene), expected));
}

// The first evaluator that wants the BVH makes it; one that failed is made again.
TEST_F(OutOfMemory, AnEvaluatorAndTheBvhThatItWants) {
  const std::vector<ViewGain> expected = gains(VoxelScene::build(map_.grid));
  // One a process, Embree's device is made first: where memory runs out meanwhile, its TBB waits
  // for ever.
  (void)GainEvaluator(VoxelScene::build(map_.grid), sensor_, test::kPaper,
                      ExecConfig{1, ExecConfig::Tracer::embree});
  std::shared_ptr<const VoxelScene> scene;
  std::optional<GainEvaluator> evaluator;
  const int threw = runs_that_threw(
      [&] {
        evaluator.reset();
        if (scene == nullptr) {
          const long left = allocations_left.exchange(-1);
          scene = VoxelScene::build(map_.grid, {}, {.num_threads = 1});
          allocations_left = left;
        }
        evaluator.emplace(scene, sensor_, test::kPaper, ExecConfig{2, ExecConfig::Tracer::embree});
      },
      [&] {
        EXPECT_TRUE(test::same_bits(gains(scene), expected));
        scene = nullptr;
      });
  EXPECT_GT(threw, 20);
  ASSERT_TRUE(evaluator.has_value());
  EXPECT_TRUE(test::same_bits(evaluator->evaluate(poses_), expected));
}

TEST_F(OutOfMemory, Views) {
  const auto scene = VoxelScene::build(map_.grid);
  const std::vector<ViewGain> expected = gains(scene);
  for (const int threads : {1, 3}) {
    std::optional<GainEvaluator> evaluator;
    const auto make = [&] {
      const long left = allocations_left.exchange(-1);
      evaluator.emplace(scene, sensor_, test::kPaper, ExecConfig{threads});
      allocations_left = left;
    };
    std::vector<ViewGain> batch(poses_.size());
    int threw = runs_that_threw(
        [&] {
          make();
          evaluator->evaluate(poses_, batch);
          EXPECT_TRUE(test::same_bits(batch, expected));
        },
        [&] { EXPECT_TRUE(test::same_bits(evaluator->evaluate(poses_), expected)); });
    EXPECT_GT(threw, 10) << threads << " threads, a batch";

    ViewGain one;
    threw = runs_that_threw(
        [&] {
          make();
          one = evaluator->evaluate(poses_[3]);
          EXPECT_TRUE(test::same_bits(one, expected[3]));
        },
        [&] {
          EXPECT_TRUE(test::same_bits(evaluator->evaluate(poses_[3]), expected[3]));
          EXPECT_TRUE(test::same_bits(evaluator->evaluate(poses_), expected));
        });
    EXPECT_GT(threw, 10) << threads << " threads, one view";

    std::vector<RayHit> hits;
    const std::vector<RayHit> hits_expected = evaluator->trace(poses_[5]);
    threw = runs_that_threw(
        [&] { hits = evaluator->trace(poses_[5]); },
        [&] { EXPECT_TRUE(test::same_bits(evaluator->evaluate(poses_), expected)); });
    EXPECT_GT(threw, 1) << threads << " threads, a trace";
    EXPECT_EQ(hits.size(), hits_expected.size());
  }
}

}  // namespace
}  // namespace viewgain
