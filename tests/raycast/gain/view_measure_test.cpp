// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains of the user's own, and depth images.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <stop_token>
#include <tuple>
#include <vector>

#include "core/expect_error.hpp"
#include "oracle/gain.hpp"
#include "oracle/rays.hpp"
#include "raycast/scene_makers.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

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
  test::expect_error(ErrorCode::invalid_argument, "60 poses, but the array has room for 59",
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
  test::expect_error(ErrorCode::invalid_argument, "deviates from a rigid transform by inf",
                     [&] { (void)depth_image(GainEvaluator(scene_, sensor_), poses_[2]); });
}

// Contributions by voxel against the oracle's gain of the rays that end there.

constexpr std::uint64_t kSeeds = test::kSlowBuild ? 1 : 6;

bool comes_before(const VoxelContribution& a, const VoxelContribution& b) {
  if (a.gain != b.gain) return a.gain > b.gain;
  return std::tuple(a.voxel.x, a.voxel.y, a.voxel.z) < std::tuple(b.voxel.x, b.voxel.y, b.voxel.z);
}

/// The hits that end in one voxel; the others end nowhere.
std::vector<RayHit> those_in(const std::vector<RayHit>& hits, Index3 voxel) {
  std::vector<RayHit> own(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const bool gains =
        hits[i].kind == RayHit::Kind::unknown || hits[i].kind == RayHit::Kind::occupied;
    if (gains && hits[i].voxel == voxel) own[i] = hits[i];
  }
  return own;
}

TEST(ViewContributions, AreTheOraclesGainsOfSingleVoxelsAndAddUp) {
  std::uint64_t views = 0, voxels = 0, occupied = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const test::MapFamily family :
         {test::MapFamily::salt_and_pepper_1, test::MapFamily::salt_and_pepper_30,
          test::MapFamily::tiles_8, test::MapFamily::tiles_128, test::MapFamily::rotated}) {
      test::Random random(900 + seed);
      const test::RandomMap map = test::random_map(family, random);
      const Sensor sensor = test::random_sensor(map.grid, random);
      Box half = map.grid.workspace();
      half.max[0] = 0.5 * (half.min[0] + half.max[0]);
      const auto scene = VoxelScene::build(map.grid);
      for (const Criterion criterion :
           {Criterion::log_diagonal, Criterion::log_determinant, Criterion::trace}) {
        GainConfig config = test::by_paper(criterion);
        if (criterion == Criterion::log_determinant) config.weights = {{half, 2.5}};
        const GainEvaluator evaluator(scene, sensor, config, {.num_threads = 1});
        for (const Pose& pose : test::random_poses(map, 4, random)) {
          const ViewGain whole = evaluator.evaluate(pose);
          const std::vector<VoxelContribution> parts = evaluator.contributions(pose);
          const std::vector<RayHit> hits = evaluator.trace(pose);
          ++views;
          EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end(), comes_before));
          double sum = 0;
          std::uint32_t rays = 0, unknown = 0;
          for (const VoxelContribution& part : parts) {
            sum += part.gain;
            rays += part.rays;
            if (part.state == VoxelState::unknown) ++unknown;
          }
          EXPECT_NEAR(sum, whole.gain, 1e-9 * whole.gain);
          EXPECT_EQ(rays, whole.hits);
          EXPECT_EQ(unknown, whole.unknown_voxels);
          EXPECT_EQ(parts.size() - unknown, whole.occupied_voxels);
          // The largest and some of the rest: the oracle's own cost is a view each.
          for (std::size_t i = 0; i < parts.size(); i += 1 + i / 8) {
            const VoxelContribution& part = parts[i];
            const ViewGain expected =
                oracle::gain_of_hits(map.grid, sensor, config, pose, those_in(hits, part.voxel));
            EXPECT_NEAR(part.gain, expected.gain, 1e-6 * expected.gain);
            EXPECT_EQ(part.rays, expected.hits);
            EXPECT_EQ(part.state, map.grid.state(part.voxel));
            EXPECT_EQ(expected.occupied_voxels, part.state == VoxelState::occupied ? 1U : 0U);
            ++voxels;
            occupied += expected.occupied_voxels;
          }
        }
      }
    }
  }
  EXPECT_EQ(views, kSeeds * 5 * 3 * 4);
  EXPECT_GT(voxels, kSeeds * 400);
  EXPECT_GT(occupied, kSeeds * 50);
}

TEST(ViewContributions, NoneForABadPoseOrACameraInAnOccupiedVoxel) {
  const BeliefGrid grid = test::sparse_map({16, 16, 16}, {{4, 4, 4}, {4, 4, 9}});
  const GainEvaluator evaluator(VoxelScene::build(grid), test::lattice_sensor(3, 3), test::kPaper);
  Pose pose = test::axis_pose({4.5, 4.5, 6.5}, 2, true);
  EXPECT_EQ(evaluator.contributions(pose).size(), 1U);
  EXPECT_TRUE(evaluator.contributions(test::axis_pose({4.5, 4.5, 4.5}, 2, true)).empty());
  pose.m[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(evaluator.contributions(pose).empty());
}

// What becomes of a view's rays: against the oracle's rays, and by hand.

using RayOutcomes = GainEvaluator::RayOutcomes;

using Kind = RayHit::Kind;

std::uint32_t sum(const RayOutcomes& o) {
  return o.too_near + o.unknown + o.known_surface + o.obstacle + o.out_of_range + o.out_of_map;
}

// The oracle walks its rays in double precision; some graze voxels that ours do not.
std::uint32_t difference(const RayOutcomes& a, const RayOutcomes& b) {
  const auto off = [](std::uint32_t x, std::uint32_t y) { return x > y ? x - y : y - x; };
  return off(a.too_near, b.too_near) + off(a.unknown, b.unknown) +
         off(a.known_surface, b.known_surface) + off(a.obstacle, b.obstacle) +
         off(a.out_of_range, b.out_of_range) + off(a.out_of_map, b.out_of_map);
}

// What lies beyond the limit [m] is not met.
Kind within(const RayHit& hit, double limit) { return hit.range > limit ? Kind::none : hit.kind; }

TEST(RayOutcomes, AreThoseOfTheOraclesRays) {
  std::uint32_t rays = 0, off = 0;
  RayOutcomes seen;
  int cases = 0;
  for (const test::MapFamily family : test::kMapFamilies) {
    test::Random random(70 + static_cast<std::uint64_t>(family));
    const test::RandomMap made = test::random_map(family, random);
    Sensor sensor = test::random_sensor(made.grid, random);
    const oracle::DenseMap map(made.grid);
    const double v = made.grid.voxel_size();
    // An obstacle among what is seen, and limits that some rays reach.
    const Obstacles obstacles{{Box{{0, 0, 0}, {4 * v, 3 * v, 5 * v}}}, {}};
    sensor.min_range = 4 * v;
    sensor.max_range = 30 * v;
    sensor.working_distance = 10 * v;
    const auto scene = VoxelScene::build(made.grid, {obstacles});
    const GainEvaluator evaluator(scene, sensor);
    for (const Pose& pose : test::random_poses(made, 4, random)) {
      const RayOutcomes found = evaluator.outcomes(pose);
      EXPECT_EQ(sum(found), found.rays);
      EXPECT_EQ(found.rays, evaluator.evaluate(pose).rays);
      const auto far = oracle::trace(map, sensor, {}, pose, obstacles);
      const auto view = oracle::view_rays(map.T_world_grid, v, sensor.camera, 1, pose);
      RayOutcomes expected;
      for (std::size_t i = 0; i < far.size(); ++i) {
        const Eigen::Vector3d end = view[i].origin + view[i].direction * (sensor.max_range / v);
        const Index3 last{static_cast<std::int32_t>(std::floor(end.x())),
                          static_cast<std::int32_t>(std::floor(end.y())),
                          static_cast<std::int32_t>(std::floor(end.z()))};
        const Kind kind = within(far[i], sensor.max_range);
        if (kind == Kind::obstacle && far[i].range < sensor.min_range) {
          ++expected.too_near;
        } else if (kind == Kind::none) {
          ++(map.inside(last) ? expected.out_of_range : expected.out_of_map);
        } else {
          ++(kind == Kind::unknown    ? expected.unknown
             : kind == Kind::occupied ? expected.known_surface
                                      : expected.obstacle);
        }
      }
      rays += found.rays;
      off += difference(found, expected);
      seen.too_near += found.too_near;
      seen.unknown += found.unknown;
      seen.known_surface += found.known_surface;
      seen.obstacle += found.obstacle;
      seen.out_of_range += found.out_of_range;
      seen.out_of_map += found.out_of_map;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 32);
  EXPECT_LE(off, rays / 1000) << "of " << rays;
  for (const std::uint32_t count : {seen.too_near, seen.unknown, seen.known_surface, seen.obstacle,
                                    seen.out_of_range, seen.out_of_map}) {
    EXPECT_GT(count, rays / 500);
  }
}

// Free space and a plane across it: by the surface gains rays end there, by the paper's they leave.
TEST(RayOutcomes, TheSupportPlaneEndsRaysOfTheSurfaceGains) {
  BeliefGrid grid({0.1, {{-2, -2, 0}, {2, 2, 3}}, {}, 0.05});
  for (std::int32_t i = 0; i < 40 * 40 * 30; ++i) {
    const std::int32_t z = i % 30;
    if (z >= 2) grid.set({i / 1200 - 20, i / 30 % 40 - 20, z}, -1.0F);
  }
  Sensor sensor = sensor_preset("sr4000");
  sensor.min_range = 0.2;
  const Pose down = look_at({0.02, 0.03, 1.5}, {0.02, 0.03, 0}, Eigen::Vector3d::UnitX());
  const auto count = [&](GainModel model, double plane, double min_range) {
    GainConfig config;
    config.model = model;
    config.min_range = min_range;
    return GainEvaluator(VoxelScene::build(grid, {{}, plane}), sensor, config).outcomes(down);
  };
  const RayOutcomes seen = count(GainModel::combined, 0.5, 0.2);
  EXPECT_EQ(seen.obstacle, seen.rays);
  EXPECT_EQ(count(GainModel::combined, 0.5, 1.6).too_near, seen.rays);
  EXPECT_EQ(count(GainModel::paper, 0.5, 0.2).unknown, seen.rays);  // the layers below
  EXPECT_EQ(count(GainModel::surface, 0.1, 0.2).unknown, seen.rays);
  EXPECT_EQ(count(GainModel::surface, 2.0, 0.2).unknown, seen.rays);  // it is above the camera
}

TEST(RayOutcomes, OfABadPoseAreNone) {
  test::Random random(3);
  const test::RandomMap made = test::random_map(test::MapFamily::salt_and_pepper_1, random);
  const GainEvaluator evaluator(VoxelScene::build(made.grid),
                                test::random_sensor(made.grid, random));
  const Pose bad{Eigen::Matrix3d::Identity(), {std::nan(""), 0, 0}};
  EXPECT_EQ(evaluator.outcomes(bad).rays, 0U);
}

}  // namespace
}  // namespace viewgain
