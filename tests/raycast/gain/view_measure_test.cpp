// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains of the user's own, and depth images.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <stop_token>

#include "core/expect_error.hpp"
#include "oracle/gain.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/raycast/depth_image.hpp"

namespace viewgain {
namespace {

/// Compares what it is given with trace() and the grid, and counts.
class Checking : public ViewMeasure {
 public:
  Checking(const GainEvaluator& evaluator, const BeliefGrid& grid, const Sensor& sensor)
      : evaluator_(evaluator), grid_(grid), sensor_(sensor) {}

  double measure(const Pose& T_world_camera,
                 std::span<const ViewMeasure::Hit> hits) const override {
    const std::vector<RayHit> expected = evaluator_.trace(T_world_camera);
    const std::vector<oracle::Ray> rays =
        oracle::view_rays(grid_.T_world_grid(), grid_.voxel_size(), sensor_.camera,
                          evaluator_.pixel_stride(), T_world_camera);
    const Eigen::Matrix3d R_world_grid = grid_.T_world_grid().rotation();
    for (const ViewMeasure::Hit& hit : hits) {
      const RayHit& same = expected.at(hit.ray);
      EXPECT_EQ(hit.voxel, same.voxel);
      EXPECT_EQ(hit.state,
                same.kind == RayHit::Kind::occupied ? VoxelState::occupied : VoxelState::unknown);
      EXPECT_EQ(hit.range, same.range);
      EXPECT_EQ(hit.state, grid_.state(hit.voxel));
      const std::optional<Belief> belief = grid_.belief(hit.voxel);
      EXPECT_EQ(hit.belief != nullptr, belief.has_value());
      if (hit.belief != nullptr && belief) {
        EXPECT_EQ(*hit.belief, *belief);
        ++beliefs;
      }
      const Eigen::Vector3d direction(hit.direction[0], hit.direction[1], hit.direction[2]);
      EXPECT_LT((direction - R_world_grid * rays.at(hit.ray).direction).norm(), 1e-6);
      EXPECT_NEAR(direction.norm(), 1, 1e-12);
    }
    return static_cast<double>(hits.size());
  }

  mutable std::atomic<int> beliefs{0};

 private:
  const GainEvaluator& evaluator_;
  const BeliefGrid& grid_;
  const Sensor& sensor_;
};

class Own : public testing::Test {
 protected:
  Own() {
    for (const int i : {2, 9, 30}) poses_[static_cast<std::size_t>(i)].m[0] = kNan;
  }

  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  test::Random random_{31};
  test::RandomMap map_ = test::random_map(test::MapFamily::rotated, random_);
  Sensor sensor_ = test::random_sensor(map_.grid, random_);
  std::vector<Pose> poses_ = test::random_poses(map_, 60, random_);
  std::shared_ptr<const VoxelScene> scene_ = VoxelScene::build(map_.grid);
};

TEST_F(Own, SeesTheHitsOfTheViews) {
  int hits = 0, in_occupied = 0, bad = 0, beliefs = 0;
  for (const int stride : {1, 3}) {
    for (const int threads : {1, 3}) {
      const GainConfig config{.model = GainModel::paper, .pixel_stride = stride};
      const GainEvaluator evaluator(scene_, sensor_, config, {.num_threads = threads});
      const Checking own(evaluator, map_.grid, sensor_);
      const std::vector<ViewGain> gains = evaluator.evaluate(poses_);
      std::vector<double> results(poses_.size());
      std::size_t last = 0;
      const BatchControl control{.progress = [&](std::size_t done, std::size_t) { last = done; }};
      EXPECT_EQ(evaluator.evaluate(poses_, results, own, control), poses_.size());
      EXPECT_EQ(last, poses_.size());
      for (std::size_t i = 0; i < poses_.size(); ++i) {
        if (gains[i].status == ViewGain::Status::bad_pose) {
          EXPECT_TRUE(std::isnan(results[i]));
          ++bad;
          continue;
        }
        if (gains[i].status == ViewGain::Status::camera_in_occupied) ++in_occupied;
        EXPECT_EQ(results[i], gains[i].hits);
        hits += static_cast<int>(gains[i].hits);
      }
      beliefs += own.beliefs;
    }
  }
  EXPECT_EQ(bad, 4 * 3);
  EXPECT_GT(in_occupied, 0);
  EXPECT_GT(hits, 10'000);
  EXPECT_GT(beliefs, 1000);
}

class Counting : public ViewMeasure {
 public:
  double measure(const Pose&, std::span<const ViewMeasure::Hit>) const override {
    if (++calls == throw_at) throw std::out_of_range("the user's own");
    return 1;
  }
  mutable std::atomic<int> calls{0};
  int throw_at = 0;
};

TEST_F(Own, ItsExceptionReachesTheCallerAndTheEvaluatorGoesOn) {
  for (const int threads : {1, 3}) {
    const GainEvaluator evaluator(scene_, sensor_, test::kPaper, {.num_threads = threads});
    std::vector<double> results(poses_.size());
    Counting own;
    own.throw_at = 5;
    EXPECT_THROW(evaluator.evaluate(poses_, results, own), std::out_of_range);
    own.calls = 100;
    EXPECT_EQ(evaluator.evaluate(poses_, results, own), poses_.size());
  }
}

TEST_F(Own, StopsEarlyAndSizesMustAgree) {
  const GainEvaluator evaluator(scene_, sensor_, test::kPaper, {.num_threads = 2});
  const Counting own;
  std::stop_source source;
  BatchControl control{.stop = source.get_token()};
  control.progress = [&](std::size_t done, std::size_t) {
    if (done >= 10) source.request_stop();
  };
  std::vector<double> results(poses_.size(), 7);
  const std::size_t done = evaluator.evaluate(poses_, results, own, control);
  EXPECT_GE(done, 10U);
  EXPECT_LT(done, poses_.size());
  EXPECT_TRUE(std::isnan(results.back()));
  results.pop_back();
  test::expect_error(ErrorCode::invalid_argument, "60 poses but room for 59",
                     [&] { evaluator.evaluate(poses_, results, own); });
}

TEST_F(Own, DepthImageIsWhereRaysEndAlongTheOpticalAxis) {
  std::size_t pixels = 0, ends = 0;
  for (const int stride : {1, 2, 7}) {
    const GainEvaluator evaluator(scene_, sensor_, {.pixel_stride = stride});
    for (std::size_t k = 0; k < 12; k += 3) {
      const Pose& pose = poses_[k];
      if (std::isnan(pose.m[0])) continue;
      const std::vector<RayHit> hits = evaluator.trace(pose);
      const std::vector<oracle::Ray> rays = oracle::view_rays(
          map_.grid.T_world_grid(), map_.grid.voxel_size(), sensor_.camera, stride, pose);
      const Eigen::Vector3d axis =
          map_.grid.T_world_grid().rotation().transpose() * pose.rotation().col(2);
      std::vector<RayHit::Kind> labels;
      const DepthFrame image = depth_image(evaluator, pose, &labels);
      ASSERT_EQ(image.width, (25 + stride - 1) / stride);
      ASSERT_EQ(image.height, (19 + stride - 1) / stride);
      ASSERT_EQ(image.depth.size(), hits.size());
      ASSERT_EQ(labels.size(), hits.size());
      for (std::size_t i = 0; i < hits.size(); ++i, ++pixels) {
        EXPECT_EQ(labels[i], hits[i].kind);
        if (hits[i].kind == RayHit::Kind::none) {
          EXPECT_EQ(image.depth[i], std::numeric_limits<float>::infinity());
          continue;
        }
        EXPECT_NEAR(image.depth[i], hits[i].range * rays[i].direction.dot(axis),
                    1e-6 * hits[i].range);
        ++ends;
      }
    }
  }
  EXPECT_GT(pixels, 1000U);
  EXPECT_GT(ends, 500U);
  test::expect_error(ErrorCode::invalid_argument, "off from a rigid transform by inf",
                     [&] { (void)depth_image(GainEvaluator(scene_, sensor_), poses_[2]); });
}

}  // namespace
}  // namespace viewgain
