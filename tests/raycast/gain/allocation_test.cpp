// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Nothing is allocated per pose in the steady state. This program replaces the global operator new.
#include <gtest/gtest.h>

#include <atomic>

#include "core/replaced_new.hpp"
#include "raycast/scene_makers.hpp"

namespace {

std::atomic<std::size_t> allocations{0};

}  // namespace

void on_allocation(std::size_t /*size*/) { allocations.fetch_add(1, std::memory_order_relaxed); }

namespace viewgain {
namespace {

TEST(Allocation, TheCounterCounts) {
  const std::size_t before = allocations;
  std::vector<double> numbers(1000);
  numbers[0] = 1;
  EXPECT_GT(allocations, before);
}

// A thread's buffers grow to the largest view that it has scored. Which thread gets which pose is
// not determined, so with several threads it may take some batches until all have grown.
TEST(Allocation, NonePerPoseInTheSteadyState) {
  const auto [map, sensor, poses] = test::random_case(4, test::MapFamily::salt_and_pepper_30, 100);
  std::vector<ViewGain> results(poses.size());
  for (const Criterion criterion :
       {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
    for (const int threads : {1, 2}) {
      const GainEvaluator evaluator(VoxelScene::build(map.grid), sensor, test::by_paper(criterion),
                                    {.num_threads = threads});
      const auto allocations_of_a_batch = [&] {
        const std::size_t before = allocations;
        evaluator.evaluate(poses, results);
        return allocations - before;
      };
      EXPECT_GT(allocations_of_a_batch(), 0U);
      std::size_t last = allocations_of_a_batch();
      if (threads == 1) {
        EXPECT_EQ(last, 0U);
      }
      for (int i = 0; i < 60 && last != 0; ++i) last = allocations_of_a_batch();
      EXPECT_EQ(last, 0U);
      if (threads == 1) {
        const std::size_t before = allocations;
        for (const Pose& pose : poses) results[0] = evaluator.evaluate(pose);
        EXPECT_EQ(allocations - before, 0U);
      }
      EXPECT_GT(test::gaining(results), 0U);
    }
  }
}

}  // namespace
}  // namespace viewgain
