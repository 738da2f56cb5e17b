// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Batches: bad poses among good ones, progress, cancellation, ranking.
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <stop_token>

#include "raycast/scene_makers.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Batch : public testing::Test {
 protected:
  Batch() {
    test::Random random(77);
    const test::RandomMap map = test::random_map(test::MapFamily::salt_and_pepper_1, random);
    sensor_ = test::random_sensor(map.grid, random);
    poses_ = test::random_poses(map, 200, random);
    scene_ = VoxelScene::build(map.grid);
  }

  [[nodiscard]] GainEvaluator evaluator(int threads = 2) const {
    return {scene_, sensor_, test::kPaper, {.num_threads = threads}};
  }

  Sensor sensor_;
  std::vector<Pose> poses_;
  std::shared_ptr<const VoxelScene> scene_;
};

TEST_F(Batch, PosteriorEntropyIsThereIfAskedForAndChangesNothingElse) {
  for (const Criterion criterion :
       {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
    const std::vector<ViewGain> without =
        GainEvaluator(scene_, sensor_, test::by_paper(criterion)).evaluate(poses_);
    GainConfig config = test::by_paper(criterion);
    config.posterior_entropy = true;
    std::vector<ViewGain> with = GainEvaluator(scene_, sensor_, config).evaluate(poses_);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      ASSERT_EQ(with[i].status, without[i].status);
      EXPECT_TRUE(std::isnan(without[i].posterior_entropy));
      if (with[i].hits > 0) changed += with[i].posterior_entropy != 0 ? 1 : 0;
      EXPECT_FALSE(std::isnan(with[i].posterior_entropy));
      with[i].posterior_entropy = without[i].posterior_entropy;
      EXPECT_TRUE(test::same_bits(with[i], without[i]));
    }
    EXPECT_GE(changed, 50U);
  }
}

TEST_F(Batch, EveryCallReportsProgressOneAtATimeUpToItsTotal) {
  const GainEvaluator own = evaluator(3);
  const auto expect_reports = [&](std::size_t total, const auto& call) {
    std::mutex mutex;
    std::size_t last = 0, calls = 0;
    BatchControl control;
    control.progress = [&](std::size_t done, std::size_t of) {
      const std::unique_lock lock(mutex, std::try_to_lock);
      EXPECT_TRUE(lock.owns_lock());
      EXPECT_GE(done, last);
      EXPECT_EQ(of, total);
      last = done;
      ++calls;
    };
    call(control);
    EXPECT_EQ(last, total);
    EXPECT_GT(calls, 0U);
  };
  const std::size_t n = poses_.size();
  expect_reports(n, [&](const BatchControl& c) {
    std::vector<ViewGain> results(n);
    EXPECT_EQ(own.evaluate(poses_, results, c), n);
    EXPECT_TRUE(test::same_bits(results, own.evaluate(poses_)));
  });
  expect_reports(n,
                 [&](const BatchControl& c) { EXPECT_TRUE(own.best(poses_, 2, {}, c).complete); });
  expect_reports(n,
                 [&](const BatchControl& c) { EXPECT_TRUE(own.race(poses_, 2, {}, c).complete); });
  expect_reports(3, [&](const BatchControl& c) { (void)own.best_set(poses_, 3, c); });
  expect_reports(n, [&](const BatchControl& c) {
    std::vector<ApproximateGain> results(n);
    EXPECT_EQ(own.approximate(poses_, results, {}, c), n);
  });
}

TEST_F(Batch, StopsEarlyAndMarksWhatItDidNotReach) {
  const std::vector<ViewGain> expected = evaluator().evaluate(poses_);
  for (const int threads : {1, 3}) {
    std::stop_source source;
    BatchControl control{.stop = source.get_token()};
    control.progress = [&](std::size_t done, std::size_t) {
      if (done >= 20) source.request_stop();
    };
    std::vector<ViewGain> results(poses_.size(),
                                  ViewGain{.gain = 5, .status = ViewGain::Status::ok});
    const std::size_t scored = evaluator(threads).evaluate(poses_, results, control);
    EXPECT_GE(scored, 20U);
    EXPECT_LT(scored, poses_.size());
    std::size_t ok = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (results[i].status == ViewGain::Status::bad_pose) {
        EXPECT_TRUE(std::isnan(results[i].gain));
        continue;
      }
      EXPECT_TRUE(test::same_bits(expected[i], results[i]));
      ++ok;
    }
    EXPECT_EQ(ok, scored);
  }
}

TEST_F(Batch, CancellingIsAskedBetweenPosesOfEveryCall) {
  for (const int threads : {1, 3}) {
    const GainEvaluator own = evaluator(threads);
    std::size_t asked = 0;
    BatchControl control{.is_cancelled = [&] { return ++asked > 20; }};
    std::vector<ViewGain> results(poses_.size());
    EXPECT_EQ(own.evaluate(poses_, results, control), 20U);
    EXPECT_EQ(asked, 21U);  // and not again
    asked = 0;
    EXPECT_FALSE(own.best(poses_, 1, {}, control).complete);
    asked = 0;
    EXPECT_FALSE(own.race(poses_, 1, {}, control).complete);
    asked = 0;
    EXPECT_FALSE(own.best_set(poses_, 2, control).complete);
    EXPECT_EQ(asked, 21U);
  }
}

// Whoever measures a view waits until as many are at it as there are threads.
class Meeting final : public ViewMeasure {
 public:
  explicit Meeting(int size) : size_(size) {}

  double measure(const Pose&, std::span<const ViewMeasure::Hit>) const override {
    std::unique_lock lock(mutex_);
    ++here_;
    changed_.notify_all();
    const bool met =
        changed_.wait_for(lock, std::chrono::seconds(60), [&] { return here_ >= size_; });
    all_met_ = all_met_ && met;
    return met ? 1 : 0;
  }
  [[nodiscard]] bool all_met() const { return all_met_; }

 private:
  int size_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  mutable int here_ = 0;
  mutable bool all_met_ = true;
};

TEST_F(Batch, AllThreadsTakePartInASmallOne) {
  const GainEvaluator own = evaluator(8);
  for (const std::size_t count : {8U, 16U, 31U}) {
    const std::vector<Pose> same(count, poses_[0]);
    std::vector<double> results(count);
    EXPECT_EQ(own.evaluate(same, results, Meeting(8)), count);
    EXPECT_EQ(results, std::vector<double>(count, 1.0));
  }
}

TEST_F(Batch, AllThreadsTakePartInTheFirstStageOfARace) {
  sensor_.camera.width = sensor_.camera.height = 60;
  const GainEvaluator own = evaluator(8);
  const std::vector<Pose> same(200, poses_[0]);
  const Meeting meeting(8);
  const BestViews raced = own.race(same, 30, {.measure = &meeting});
  EXPECT_EQ(raced.estimated, same.size());
  EXPECT_EQ(raced.worth, std::vector<double>(30, 1.0));
  EXPECT_TRUE(meeting.all_met());
}

TEST_F(Batch, AnEmptyBatchIsFineAndSizesMustAgree) {
  EXPECT_TRUE(evaluator().evaluate(std::span<const Pose>{}).empty());
  std::vector<ViewGain> results(poses_.size() - 1);
  EXPECT_THROW(evaluator().evaluate(poses_, results), Error);
}

TEST(BestIndices, LargestFirstTiesToTheLowerIndexNanLast) {
  std::vector<ViewGain> results(6);
  const std::array<double, 6> gains{1, kNan, 3, 3, 0, kNan};
  for (std::size_t i = 0; i < gains.size(); ++i) results[i].gain = gains[i];
  EXPECT_EQ(best_indices(results, 100), (std::vector<std::size_t>{2, 3, 0, 4, 1, 5}));
  EXPECT_EQ(best_indices(results, 2), (std::vector<std::size_t>{2, 3}));
  EXPECT_TRUE(best_indices(results, 0).empty());
  EXPECT_TRUE(best_indices({}, 3).empty());
}

// The same bits for any number of threads, run after run, after save and load, and across
// instruction sets.

constexpr std::array kFamilies{test::MapFamily::salt_and_pepper_30, test::MapFamily::tiles_8,
                               test::MapFamily::rotated};

TEST(Determinism, SameBitsForAnyNumberOfThreadsAndRunAfterRun) {
  std::size_t views = 0, gaining = 0;
  for (const test::MapFamily family : kFamilies) {
    const test::RandomCase made = test::random_case(11, family, 40);
    const auto scene = VoxelScene::build(made.map.grid);
    for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
      const GainConfig config{.model = model};
      const std::vector<ViewGain> expected =
          GainEvaluator(scene, made.sensor, config, {.num_threads = 1}).evaluate(made.poses);
      for (const int threads : {1, 2, 3, 8}) {
        const auto own_scene = VoxelScene::build(made.map.grid, {}, {.num_threads = threads});
        const GainEvaluator evaluator(own_scene, made.sensor, config, {.num_threads = threads});
        EXPECT_EQ(evaluator.num_threads(), threads);
        for (int run = 0; run < 3; ++run) {
          const std::vector<ViewGain> actual = evaluator.evaluate(made.poses);
          EXPECT_TRUE(test::same_bits(expected, actual));
          views += actual.size();
          gaining += test::gaining(actual);
        }
        // One by one as in a batch: the threads share each view.
        for (std::size_t i = 0; i < made.poses.size(); ++i) {
          EXPECT_TRUE(test::same_bits(expected[i], evaluator.evaluate(made.poses[i])));
        }
      }
    }
  }
  EXPECT_GT(gaining, views / 3);
}

// Of a view large enough that all threads have a part in it, its end included.
TEST(Determinism, OnePoseOnSeveralThreadsUnderEveryGainCriterionAndWeight) {
  int both_classes = 0, refining = 0;
  for (const test::MapFamily family : kFamilies) {
    test::RandomCase made = test::random_case(13, family, 6);
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
    std::vector<GainConfig> configs{{.model = GainModel::surface}, {.model = GainModel::combined}};
    for (const Criterion criterion :
         {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
      configs.push_back(test::by_paper(criterion));
    }
    for (GainConfig config : configs) {
      for (const bool is_weighted : {false, true}) {
        if (is_weighted) config.weights = {{half, 2.5}};
        const GainEvaluator alone(scene, made.sensor, config, {.num_threads = 1});
        const std::vector<ViewGain> expected = alone.evaluate(made.poses);
        for (const ViewGain& view : expected) {
          both_classes += view.unknown_voxels > 0 && view.occupied_voxels > 0 ? 1 : 0;
          refining += view.area > 0 && view.refinement_saturated > 0 ? 1 : 0;
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
  EXPECT_GT(refining, 20);
}

/// All that an evaluator says of poses, in bits.
std::vector<std::uint64_t> said_of(const GainEvaluator& evaluator, std::span<const Pose> poses) {
  std::vector<std::uint64_t> all;
  const auto say = [&](double value) { all.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const RayHit& hit : evaluator.trace(poses[0])) {
    say(static_cast<double>(hit.kind)), say(hit.voxel.x), say(hit.voxel.y), say(hit.voxel.z);
    say(static_cast<double>(hit.range));
  }
  for (const VoxelContribution& part : evaluator.contributions(poses[0])) {
    say(part.voxel.x), say(part.voxel.y), say(part.voxel.z), say(part.rays);
    say(part.expected_rays), say(part.gain);
  }
  std::vector<ApproximateGain> estimates(poses.size());
  (void)evaluator.approximate(poses, estimates);
  for (const ApproximateGain& one : estimates) say(one.gain), say(one.standard_error);
  const ViewSet set = evaluator.best_set(poses, 3);
  for (const std::size_t i : set.indices) say(static_cast<double>(i));
  for (const ViewGain& view : set.marginal) say(view.gain);
  say(set.gain), say(set.gain_by_best_alone);
  for (const std::size_t i : evaluator.race(poses, 3).indices) say(static_cast<double>(i));
  return all;
}

TEST(Determinism, SameBitsAcrossInstructionSets) {
  std::size_t cases = 0;
  for (const test::MapFamily family : kFamilies) {
    const test::RandomCase made = test::random_case(13, family, 40);
    for (const GainModel model : {GainModel::paper, GainModel::surface, GainModel::combined}) {
      std::vector<std::vector<ViewGain>> by_isa;
      std::vector<std::vector<std::uint64_t>> said;
      for (const std::string& isa : available_isas()) {
        const test::ScopedIsa scoped(isa);
        const GainEvaluator evaluator(VoxelScene::build(made.map.grid), made.sensor,
                                      {.model = model});
        EXPECT_EQ(evaluator.scene().isa(), isa);
        by_isa.push_back(evaluator.evaluate(made.poses));
        EXPECT_TRUE(test::same_bits(by_isa.front(), by_isa.back())) << isa;
        EXPECT_GT(test::gaining(by_isa.back()), made.poses.size() / 2) << isa;
        said.push_back(said_of(evaluator, made.poses));
        EXPECT_TRUE(said.back() == said.front()) << isa;
        ++cases;
      }
    }
  }
  EXPECT_EQ(cases, std::size(kFamilies) * 3 * available_isas().size());
}

}  // namespace
}  // namespace viewgain
