// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Rays for which single precision is exact, along axes, faces, edges and through corners: the
// answer must be the half-open one, with no slack, under each instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/gain.hpp"
#include "oracle_tally.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {
using Status = ViewGain::Status;

using test::axis_pose;
using test::kExactVoxel;
using test::lattice_sensor;
using test::sparse_map;

/// Each case runs under every instruction set.
class DegenerateRays : public testing::TestWithParam<std::string> {
 protected:
  /// The one ray of a 1x1 camera.
  RayHit shoot(const BeliefGrid& grid, const Pose& pose, const GainConfig& config = {}) {
    const test::ScopedIsa scoped(GetParam());
    const auto scene = VoxelScene::build(grid, {}, {.num_threads = 1});
    const GainEvaluator evaluator(scene, lattice_sensor(1, 1), config, {.num_threads = 1});
    const std::vector<RayHit> hits = evaluator.trace(pose);
    EXPECT_EQ(hits.size(), 1U);
    return hits.at(0);
  }

  ViewGain score(const BeliefGrid& grid, const Pose& pose, GainConfig config = {}) {
    config.model = GainModel::paper;
    const test::ScopedIsa scoped(GetParam());
    const auto scene = VoxelScene::build(grid, {}, {.num_threads = 1});
    return GainEvaluator(scene, lattice_sensor(1, 1), config, {.num_threads = 1}).evaluate(pose);
  }
};

void expect_hit(const RayHit& hit, RayHit::Kind kind, Index3 voxel, double range_in_voxels) {
  EXPECT_EQ(hit.kind, kind);
  EXPECT_EQ(hit.voxel, voxel);
  EXPECT_EQ(hit.range, range_in_voxels * kExactVoxel);
}

TEST_P(DegenerateRays, InAFaceBelongToTheLargerIndex) {
  // x = 8 is a face between leaves, x = 5 one inside a leaf.
  for (const int x : {5, 8}) {
    SCOPED_TRACE(x);
    const auto along_z = [&](Index3 voxel) {
      return shoot(sparse_map({16, 16, 16}, {voxel}),
                   axis_pose({static_cast<double>(x), 3.5, -1}, 2, true));
    };
    EXPECT_EQ(along_z({x - 1, 3, 9}).kind, RayHit::Kind::none);
    expect_hit(along_z({x, 3, 9}), RayHit::Kind::occupied, {x, 3, 9}, 10);
  }
}

TEST_P(DegenerateRays, InTheWorkspacesFacesAreInsideOnlyAtItsLowerOnes) {
  std::vector<Index3> all;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) all.push_back({x, y, 4});
  }
  const BeliefGrid grid = sparse_map({8, 8, 8}, all);
  expect_hit(shoot(grid, axis_pose({0, 2.5, -1}, 2, true)), RayHit::Kind::occupied, {0, 2, 4}, 5);
  EXPECT_EQ(shoot(grid, axis_pose({8, 2.5, -1}, 2, true)).kind, RayHit::Kind::none);
  expect_hit(shoot(grid, axis_pose({0, 0, -1}, 2, true)), RayHit::Kind::occupied, {0, 0, 4}, 5);
  EXPECT_EQ(shoot(grid, axis_pose({8, 8, -1}, 2, true)).kind, RayHit::Kind::none);
}

TEST_P(DegenerateRays, ThroughCornersTouchOnlyTheDiagonalsVoxels) {
  // Neighbours of the diagonal in and across leaves are touched at corners and edges only.
  std::vector<Index3> beside;
  for (int i = 1; i < 15; ++i) {
    beside.insert(beside.end(), {{i, i, i + 1}, {i, i + 1, i}, {i + 1, i, i}, {i + 1, i + 1, i}});
  }
  Sensor sensor = lattice_sensor(3, 3);
  const test::ScopedIsa scoped(GetParam());
  const auto corner_ray = [&](const BeliefGrid& grid) {
    const auto scene = VoxelScene::build(grid, {}, {.num_threads = 1});
    const GainEvaluator evaluator(scene, sensor, test::kPaper, {.num_threads = 1});
    return evaluator.trace(axis_pose({-2, -2, -2}, 2, true)).at(8);  // direction (1, 1, 1)
  };
  EXPECT_EQ(corner_ray(sparse_map({16, 16, 16}, beside)).kind, RayHit::Kind::none);
  beside.push_back({12, 12, 12});
  const RayHit hit = corner_ray(sparse_map({16, 16, 16}, beside));
  EXPECT_EQ(hit.kind, RayHit::Kind::occupied);
  EXPECT_EQ(hit.voxel, (Index3{12, 12, 12}));
  EXPECT_NEAR(hit.range, 14 * std::sqrt(3.0) * kExactVoxel, 1e-6);
}

// Into a wholly unknown box over an edge between two of its voxels.
TEST_P(DegenerateRays, OverAnEdgeIntoABoxTouchTheVoxelAheadOnly) {
  const test::ScopedIsa scoped(GetParam());
  const int edges[] = {16, 256};  // blocks of 8³, and a larger box
  for (const int edge : edges) {
    const BeliefGrid grid(
        {.voxel_size = kExactVoxel,
         .workspace = {{0, 0, 0}, {edge * kExactVoxel, edge * kExactVoxel, edge * kExactVoxel}},
         .T_world_grid = {},
         .prior_sigma = 0.1});
    const GainEvaluator evaluator(VoxelScene::build(grid, {}, {.num_threads = 1}),
                                  lattice_sensor(3, 3), test::kPaper, {.num_threads = 1});
    const std::vector<RayHit> hits = evaluator.trace(axis_pose({-2, 10, 4.5}, 0, true));
    EXPECT_EQ(hits.at(3).voxel, (Index3{0, 7, 4}));   // direction (1, -1, 0)
    EXPECT_EQ(hits.at(5).voxel, (Index3{0, 12, 4}));  // direction (1, 1, 0)
    EXPECT_EQ(hits.at(4).voxel, (Index3{0, 10, 4}));  // in the face between two: the larger index
  }
}

TEST_P(DegenerateRays, OnTheHalfVoxelLatticeEqualTheOracleExactly) {
  test::Random random(42);
  const test::ScopedIsa scoped(GetParam());
  const Sensor sensor = lattice_sensor(3, 3);
  std::size_t hits = 0, misses = 0;
  for (const double share : {0.01, 0.1, 0.4}) {
    std::vector<Index3> non_free;
    for (int i = 0; i < 20 * 20 * 20; ++i) {
      if (test::uniform(random, 0, 1) < share) {
        non_free.push_back({i / 400, i / 20 % 20, i % 20});
      }
    }
    const BeliefGrid grid = sparse_map({20, 20, 20}, non_free);
    const oracle::DenseMap map(grid);
    const auto scene = VoxelScene::build(grid, {}, {.num_threads = 1});
    for (int i = 0; i < 300; ++i) {
      const GainEvaluator evaluator(scene, sensor, test::kPaper,
                                    {1, test::kTracers.at(static_cast<std::size_t>(i / 6 % 2))});
      const auto half = [&] { return 0.5 * test::uniform_int(random, -6, 46); };
      const Pose pose = axis_pose({half(), half(), half()}, i % 3, i % 2 == 0);
      const std::vector<RayHit> expected = oracle::trace(map, sensor, {}, pose);
      const std::vector<RayHit> actual = evaluator.trace(pose);
      ASSERT_EQ(actual.size(), expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        EXPECT_TRUE(oracle::same_ending(expected[k], actual[k]))
            << "pose " << i << " at " << pose.translation().transpose() / kExactVoxel << ", ray "
            << k << ": expected " << expected[k].voxel.x << ' ' << expected[k].voxel.y << ' '
            << expected[k].voxel.z << ", got " << actual[k].voxel.x << ' ' << actual[k].voxel.y
            << ' ' << actual[k].voxel.z << " kind " << static_cast<int>(actual[k].kind);
        ++(actual[k].kind == RayHit::Kind::none ? misses : hits);
      }
    }
  }
  EXPECT_GT(hits, 2000U);
  EXPECT_GT(misses, 500U);
}

// Cameras in corners, on edges and on faces of voxels, inside them and just beside, with any
// orientation: every ray of a view starts where several voxels meet.
TEST_P(DegenerateRays, ObliqueViewsFromTheLatticeMeetTheOracle) {
  constexpr int kEdge = 24;
  test::Random random(17);
  const test::ScopedIsa scoped(GetParam());
  test::OracleTally tally;
  std::size_t from_the_first_voxel = 0;
  for (const double share : {0.004, 0.1}) {
    std::vector<Index3> non_free;
    for (int i = 0; i < kEdge * kEdge * kEdge; ++i) {
      if (test::uniform(random, 0, 1) < share) {
        non_free.push_back({i / kEdge / kEdge, i / kEdge % kEdge, i % kEdge});
      }
    }
    const BeliefGrid grid = sparse_map({kEdge, kEdge, kEdge}, non_free, VoxelState::unknown);
    const oracle::DenseMap map(grid);
    const auto scene = VoxelScene::build(grid, {}, {.num_threads = 1});
    Sensor sensor = lattice_sensor(21, 17);
    sensor.camera.fx = sensor.camera.fy = 12;
    for (const double min_range : {0.0, 1.5 * kExactVoxel}) {
      sensor.min_range = min_range;
      const GainEvaluator sweep(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::sweep});
      const GainEvaluator embree(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::embree});
      for (const double step : {0.0, 0.5, 0.25, 1.0 / 4096}) {
        for (int i = 0; i < 16; ++i) {
          Eigen::Vector3d at;
          for (int k = 0; k < 3; ++k) {
            const bool is_moved = (i >> k & 1) != 0;
            at[k] = test::uniform_int(random, 0, kEdge) + (is_moved ? step : 0.0);
          }
          const Pose pose(test::random_rigid(random, 1).rotation(), at * kExactVoxel);
          const std::vector<RayHit> own = sweep.trace(pose),
                                    expected = oracle::trace(map, sensor, {}, pose);
          tally.add(map, sensor, pose, expected, own);
          tally.add(map, sensor, pose, expected, embree.trace(pose));
          from_the_first_voxel += static_cast<std::size_t>(std::count_if(
              own.begin(), own.end(), [&](const RayHit& hit) { return hit.range == min_range; }));
        }
      }
    }
  }
  EXPECT_EQ(tally.rays, 2U * 2U * 2U * 4U * 16U * 21U * 17U);
  EXPECT_TRUE(tally.agrees(tally.rays / 3, 1e-3));
  EXPECT_GT(from_the_first_voxel, 1000U);
}

TEST_P(DegenerateRays, StartingInAnUnknownVoxelEndThere) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{7, 7, 7}}, VoxelState::unknown);
  const Pose inside = axis_pose({7.5, 7.5, 7.5}, 2, true);
  expect_hit(shoot(grid, inside), RayHit::Kind::unknown, {7, 7, 7}, 0);
  // min_range inside the voxel: the reading is taken there; beyond it: the voxel is passed.
  expect_hit(shoot(grid, inside, {.min_range = 0.25 * kExactVoxel}), RayHit::Kind::unknown,
             {7, 7, 7}, 0.25);
  EXPECT_EQ(shoot(grid, inside, {.min_range = kExactVoxel}).kind, RayHit::Kind::none);
  EXPECT_EQ(score(grid, inside, {.min_range = 0.25 * kExactVoxel}).unknown_voxels, 1U);
}

TEST_P(DegenerateRays, StartingInAnOccupiedVoxelGainNothing) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{7, 7, 7}, {7, 7, 12}});
  const ViewGain gain =
      score(grid, axis_pose({7.5, 7.5, 7.5}, 2, true), {.min_range = kExactVoxel});
  EXPECT_EQ(gain.status, Status::camera_in_occupied);
  EXPECT_EQ(gain.gain, 0.0);
  EXPECT_EQ(gain.exploration, 0.0);
  EXPECT_EQ(gain.refinement, 0.0);
  // On the face between free and occupied the centre belongs to the larger index.
  EXPECT_EQ(score(grid, axis_pose({7.5, 7.5, 7}, 2, false), {.min_range = kExactVoxel}).status,
            Status::camera_in_occupied);
  EXPECT_EQ(score(grid, axis_pose({7.5, 7.5, 8}, 2, true), {.min_range = kExactVoxel}).status,
            Status::ok);
}

TEST_P(DegenerateRays, OutsideTheWorkspaceGainNothingAndBlockNothing) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{7, 7, 7}});
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d(-40.5, 7.5, 7.5), Eigen::Vector3d(7.5, 16.5, -1),
        Eigen::Vector3d(1e6, 1e6, 1e6), Eigen::Vector3d(1e30, 7.5, 7.5)}) {
    SCOPED_TRACE(eye.transpose());
    const ViewGain gain = score(grid, axis_pose(eye, 2, true), {.posterior_entropy = true});
    EXPECT_EQ(gain.status, Status::ok);
    EXPECT_EQ(gain.gain, 0.0);
    EXPECT_EQ(gain.posterior_entropy, 0.0);
    EXPECT_EQ(gain.rays, 1U);
    EXPECT_EQ(gain.hits, 0U);
  }
}

TEST_P(DegenerateRays, LeavingMinRangeInsideAnUnknownVoxelStillGain) {
  const BeliefGrid grid = sparse_map({16, 16, 32}, {{4, 4, 7}, {4, 4, 20}}, VoxelState::unknown);
  const Pose pose = axis_pose({4.5, 4.5, 0}, 2, true);
  const auto at = [&](double min_range) {
    return shoot(grid, pose, {.min_range = min_range * kExactVoxel});
  };
  expect_hit(at(6.5), RayHit::Kind::unknown, {4, 4, 7}, 7);
  expect_hit(at(7), RayHit::Kind::unknown, {4, 4, 7}, 7);
  expect_hit(at(7.5), RayHit::Kind::unknown, {4, 4, 7}, 7.5);
  expect_hit(at(8), RayHit::Kind::unknown, {4, 4, 20}, 20);  // left exactly at min_range
  expect_hit(at(8.5), RayHit::Kind::unknown, {4, 4, 20}, 20);
  EXPECT_EQ(at(21).kind, RayHit::Kind::none);
}

TEST_P(DegenerateRays, EndAtSurfaceThatTheyEnterBeforeMinRange) {
  const BeliefGrid grid = sparse_map({16, 16, 32}, {{4, 4, 7}, {4, 4, 20}});
  const Pose pose = axis_pose({4.5, 4.5, 0}, 2, true);
  const auto from = [](float min_range) {
    return GainConfig{.min_range = double(min_range) * kExactVoxel};
  };
  expect_hit(shoot(grid, pose, from(7)), RayHit::Kind::occupied, {4, 4, 7}, 7);
  for (const float min_range : {std::nextafter(7.0F, 8.0F), 7.5F, 8.0F, 8.5F, 19.0F, 25.0F}) {
    SCOPED_TRACE(min_range);
    expect_hit(shoot(grid, pose, from(min_range)), RayHit::Kind::obstacle, {}, 7);
    EXPECT_EQ(score(grid, pose, from(min_range)).hits, 0U);
  }
}

// A camera in an occupied voxel gains nothing, but sees from there.
TEST_P(DegenerateRays, SeeOutOfTheVoxelThatTheyStartIn) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{7, 7, 7}, {7, 7, 12}});
  const Pose inside = axis_pose({7.5, 7.5, 7.5}, 2, true);
  expect_hit(shoot(grid, inside, {.min_range = 1.5 * kExactVoxel}), RayHit::Kind::occupied,
             {7, 7, 12}, 4.5);
}

TEST_P(DegenerateRays, EntryAtMaxRangeCountsAndBeyondDoesNot) {
  // Inside a leaf, on a leaf's face, and a tile of unknown voxels.
  const BeliefGrid inside_leaf = sparse_map({16, 16, 32}, {{4, 4, 13}});
  const BeliefGrid on_face = sparse_map({16, 16, 32}, {{4, 4, 16}});
  const Pose pose = axis_pose({4.5, 4.5, 0}, 2, true);
  const auto at = [&](const BeliefGrid& grid, double max_range) {
    return shoot(grid, pose, {.max_range = max_range * kExactVoxel}).kind;
  };
  EXPECT_EQ(at(inside_leaf, 13), RayHit::Kind::occupied);
  EXPECT_EQ(at(inside_leaf, 12.999), RayHit::Kind::none);
  EXPECT_EQ(at(on_face, 16), RayHit::Kind::occupied);
  EXPECT_EQ(at(on_face, 15.999), RayHit::Kind::none);
}

TEST_P(DegenerateRays, NanAndUnrigidPosesAreBadAndSayNothing) {
  const BeliefGrid grid = sparse_map({16, 16, 16}, {{7, 7, 7}});
  const Pose good = axis_pose({7.5, 7.5, -4}, 2, true);
  std::vector<Pose> bad(12 + 12, good);
  for (std::size_t i = 0; i < 12; ++i) {
    bad[i].m[i] = std::numeric_limits<double>::quiet_NaN();
    bad[12 + i].m[i] = std::numeric_limits<double>::infinity();
  }
  bad.emplace_back(Eigen::Matrix3d(1.01 * good.rotation()), good.translation());
  bad.emplace_back(Eigen::Matrix3d(-good.rotation()), good.translation());
  bad.emplace_back(Eigen::Matrix3d(Eigen::Matrix3d::Zero()), good.translation());
  for (std::size_t i = 0; i < bad.size(); ++i) {
    SCOPED_TRACE(i);
    const ViewGain gain = score(grid, bad[i]);
    EXPECT_EQ(gain.status, Status::bad_pose);
    EXPECT_TRUE(std::isnan(gain.gain));
    EXPECT_EQ(gain.hits, 0U);
  }
  EXPECT_EQ(bad.size(), 27U);
  EXPECT_EQ(score(grid, {Eigen::Matrix3d(1.0002 * good.rotation()), good.translation()}).status,
            Status::ok);
}

INSTANTIATE_TEST_SUITE_P(Isa, DegenerateRays, testing::ValuesIn(available_isas()),
                         [](const auto& param) { return param.param; });

}  // namespace
}  // namespace viewgain
