// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Nothing is allocated per pose in the steady state. This program replaces the global operator new.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "raycast/scene_makers.hpp"

namespace {

std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new[](std::size_t size) { return counted(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
// For std::stable_sort's buffer; a sanitizer's own would not fit the delete below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

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
  test::Random random(4);
  const test::RandomMap map = test::random_map(test::MapFamily::salt_and_pepper_30, random);
  const Sensor sensor = test::random_sensor(map.grid, random);
  const std::vector<Pose> poses = test::random_poses(map, 100, random);
  std::vector<ViewGain> results(poses.size());
  for (const Criterion criterion :
       {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
    for (const int threads : {1, 2}) {
      const GainEvaluator evaluator(VoxelScene::build(map.grid), sensor, {.criterion = criterion},
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
