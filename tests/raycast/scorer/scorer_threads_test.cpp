// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include "raycast/scene_makers.hpp"
#include "raycast/scorer/scorer_scene.hpp"

namespace viewgain {
namespace {

using test::same_bits;

// Views are scored while the map changes: each answer is of one of the maps, in their order.
TEST(ScorerThreads, GainsDuringChangesAreOfTheMapBeforeOrAfter) {
  test::ScorerScene scene;
  scene.sensor.body_size = {0.065, 0.065, 0.076};
  constexpr std::size_t kFrames = 6;
  const std::vector<Pose> poses(scene.poses.begin(), scene.poses.begin() + 6);
  const Box region{{-0.05, -0.1, 0}, {0, 0.1, 0.1}};
  const VoxelBox box = VoxelBox::from_dims({2, 2, 2}, {6, 6, 6});
  const auto change = [&](ViewScorer& scorer, std::size_t step) {
    const std::size_t i = step / 3;
    if (step % 3 == 0) scorer.add(scene.see(scene.poses[i], i), scene.poses[i]);
    if (step % 3 == 1) scorer.forget(region);
    const auto label = static_cast<std::uint8_t>(1 + i % 2);
    if (step % 3 == 2) scorer.set(box, std::vector<std::uint8_t>(box.volume(), label));
  };
  // The answers one after the other.
  std::vector<std::vector<ViewGain>> of_map;
  std::vector<std::vector<std::size_t>> best_of_map;
  ViewScorer alone(scene.sensor, scene.config(), {1});
  const auto note = [&] {
    of_map.push_back(alone.evaluate(poses));
    best_of_map.push_back(alone.best(poses, 2).indices);
  };
  note();
  for (std::size_t step = 0; step < 3 * kFrames; ++step) {
    change(alone, step);
    note();
  }
  std::atomic<std::size_t> between{0}, unknown{0}, backwards{0}, wrong_best{0};
  // Until an answer came from between the changes.
  for (int round = 0; round < 50 && between == 0; ++round) {
    ViewScorer scorer(scene.sensor, scene.config(), {2});
    std::atomic<bool> is_done{false};
    const auto score = [&] {
      std::size_t at = 0;
      do {
        const std::vector<ViewGain> gains = scorer.evaluate(poses);
        const auto from = of_map.begin() + static_cast<std::ptrdiff_t>(at);
        const auto is_it = [&](const std::vector<ViewGain>& map) { return same_bits(map, gains); };
        const auto found = std::find_if(from, of_map.end(), is_it);
        if (found != of_map.end()) {
          at = static_cast<std::size_t>(found - of_map.begin());
          between += at > 0 && at + 1 < of_map.size() ? 1 : 0;
        } else {
          ++(std::any_of(of_map.begin(), from, is_it) ? backwards : unknown);
        }
        const std::vector<std::size_t> best = scorer.best(poses, 2).indices;
        wrong_best += std::find(best_of_map.begin(), best_of_map.end(), best) == best_of_map.end();
        (void)scorer.scene()->primitive_count();
      } while (!is_done);
    };
    std::thread first(score), second(score);
    for (std::size_t step = 0; step < 3 * kFrames; ++step) change(scorer, step);
    is_done = true;
    first.join();
    second.join();
    EXPECT_TRUE(same_bits(scorer.evaluate(poses), of_map.back()));
  }
  EXPECT_GE(between, 1U);
  EXPECT_EQ(unknown, 0U);
  EXPECT_EQ(backwards, 0U);
  EXPECT_EQ(wrong_best, 0U);
}

// Changes from several threads wait for one another.
TEST(ScorerThreads, ChangesWaitForOneAnother) {
  const test::ScorerScene scene;
  ViewScorer scorer(scene.sensor, scene.config(GainModel::paper), {1});
  const auto add = [&](std::size_t from) {
    for (std::size_t i = from; i < from + 3; ++i) {
      scorer.add(scene.see(scene.poses[i], i), scene.poses[i]);
    }
  };
  std::thread first([&] { add(0); }), second([&] { add(3); });
  first.join();
  second.join();
  EXPECT_EQ(scorer.grid().views().size(), 6U);
  EXPECT_EQ(scorer.evaluator()->evaluate(scene.poses).size(), scene.poses.size());
}

}  // namespace
}  // namespace viewgain
