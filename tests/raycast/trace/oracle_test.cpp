// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The oracle itself, by hand: its rules, and that its proof of ties refuses real errors.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/gain.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using oracle::DenseMap;
using oracle::Ray;
using oracle::RayLimits;
using test::kExactVoxel;
using test::sparse_map;

RayHit hit(RayHit::Kind kind, Index3 voxel = {}) { return {kind, voxel, 0}; }

TEST(Oracle, VisitsAreConsecutiveAndInsideTheirVoxels) {
  test::Random random(7);
  const DenseMap map(sparse_map({9, 7, 5}, {}));
  std::size_t visits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = test::random_rigid(random, 8);
    const Ray ray{pose.translation(), pose.rotation().col(2)};
    double last = -1;
    oracle::walk(map, ray, [&](Index3 voxel, double t_in, double t_out) {
      EXPECT_LT(t_in, t_out);
      EXPECT_TRUE(last < 0 || t_in == last);
      last = t_out;
      const Eigen::Vector3d middle = ray.origin + 0.5 * (t_in + t_out) * ray.direction;
      EXPECT_EQ(std::floor(middle.x()), voxel.x);
      EXPECT_EQ(std::floor(middle.y()), voxel.y);
      EXPECT_EQ(std::floor(middle.z()), voxel.z);
      ++visits;
      return false;
    });
  }
  EXPECT_GT(visits, 1000U);
}

TEST(Oracle, RefusesWrongVoxelsAndAcceptsGrazedOnes) {
  const DenseMap map(sparse_map({16, 16, 16}, {{4, 4, 8}, {4, 5, 6}, {4, 4, 12}, {9, 9, 9}}));
  const RayLimits limits;
  const auto occupied = RayHit::Kind::occupied;
  // Through the middle of (4,4,8): nothing else will do.
  const Ray middle{{4.5, 4.5, 0}, Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(oracle::first_hit(map, middle, limits).voxel, (Index3{4, 4, 8}));
  EXPECT_TRUE(oracle::is_tie(map, middle, limits, hit(occupied, {4, 4, 8})));
  EXPECT_FALSE(oracle::is_tie(map, middle, limits, hit(occupied, {4, 5, 6})));
  EXPECT_FALSE(oracle::is_tie(map, middle, limits, hit(occupied, {4, 4, 12})));
  EXPECT_FALSE(oracle::is_tie(map, middle, limits, hit(occupied, {9, 9, 9})));
  EXPECT_FALSE(oracle::is_tie(map, middle, limits, hit(occupied, {4, 4, 7})));
  EXPECT_FALSE(oracle::is_tie(map, middle, limits, hit(RayHit::Kind::unknown, {4, 4, 8})));
  EXPECT_FALSE(oracle::is_tie(map, middle, limits, hit(RayHit::Kind::none)));
  // Within 1e-4 of (4,5,6)'s face: either; 1e-3 away: no longer.
  const Ray near{{4.5, 5 - 5e-5, 0}, Eigen::Vector3d::UnitZ()};
  EXPECT_EQ(oracle::first_hit(map, near, limits).voxel, (Index3{4, 4, 8}));
  EXPECT_TRUE(oracle::is_tie(map, near, limits, hit(occupied, {4, 5, 6})));
  EXPECT_FALSE(oracle::is_tie(map, near, limits, hit(occupied, {4, 4, 12})));
  EXPECT_FALSE(oracle::is_tie(map, near, limits, hit(RayHit::Kind::none)));
  const Ray off{{4.5, 5 - 1e-3, 0}, Eigen::Vector3d::UnitZ()};
  EXPECT_FALSE(oracle::is_tie(map, off, limits, hit(occupied, {4, 5, 6})));
  // Entering a voxel within 1e-4 of min_range, before which it blocks; max_range likewise.
  const RayLimits grazing_min{.min_range = 8 + 5e-5};
  EXPECT_EQ(oracle::first_hit(map, middle, grazing_min).kind, RayHit::Kind::obstacle);
  EXPECT_TRUE(oracle::is_tie(map, middle, grazing_min, hit(occupied, {4, 4, 8})));
  EXPECT_FALSE(oracle::is_tie(map, middle, grazing_min, hit(occupied, {4, 4, 12})));
  const RayLimits inside_min{.min_range = 8.5};
  EXPECT_FALSE(oracle::is_tie(map, middle, inside_min, hit(occupied, {4, 4, 8})));
  EXPECT_FALSE(oracle::is_tie(map, middle, inside_min, hit(occupied, {4, 4, 12})));
  const RayLimits grazing_max{.max_range = 8 + 5e-5};
  EXPECT_TRUE(oracle::is_tie(map, middle, grazing_max, hit(RayHit::Kind::none)));
  const RayLimits short_max{.max_range = 7};
  EXPECT_FALSE(oracle::is_tie(map, middle, short_max, hit(occupied, {4, 4, 8})));
}

TEST(Oracle, AnEdgePassedExactlyIsATieOfACutOne) {
  // The ray cuts (5,5,z)'s edge by 2e-5 voxel; through the edge itself it would go on to (6,6,z).
  const double h = std::sqrt(0.5);
  const DenseMap map(sparse_map({16, 16, 16}, {{6, 5, 4}, {5, 6, 4}, {6, 6, 4}}));
  for (const double off : {2e-5, -2e-5}) {
    const Ray ray{{2 + off, 2 - off, 4.5}, {h, h, 0}};
    const Index3 first = off > 0 ? Index3{6, 5, 4} : Index3{5, 6, 4};
    EXPECT_EQ(oracle::first_hit(map, ray, {}).voxel, first);
    EXPECT_TRUE(oracle::is_tie(map, ray, {}, hit(RayHit::Kind::occupied, {6, 6, 4})));
    EXPECT_FALSE(oracle::is_tie(map, ray, {}, hit(RayHit::Kind::none)));
  }
  const Ray deep{{2 + 2e-4, 2 - 2e-4, 4.5}, {h, h, 0}};
  EXPECT_FALSE(oracle::is_tie(map, deep, {}, hit(RayHit::Kind::occupied, {6, 6, 4})));
}

TEST(Oracle, ALeakThroughASeamIsNoTie) {
  // A wall of two layers; rays in the faces and edges between its voxels.
  std::vector<Index3> wall;
  for (int x = 0; x < 16; ++x) {
    for (int y = 0; y < 16; ++y) {
      wall.push_back({x, y, 8});
      wall.push_back({x, y, 9});
    }
  }
  const DenseMap map(sparse_map({16, 16, 16}, wall));
  for (const double x : {8.0, 8.0 - 1e-9, 8.0 + 1e-9, 8.5}) {
    for (const double y : {4.0, 4.5}) {
      const Ray ray{{x, y, 0}, Eigen::Vector3d::UnitZ()};
      EXPECT_FALSE(oracle::is_tie(map, ray, {}, hit(RayHit::Kind::none)));
      EXPECT_FALSE(oracle::is_tie(map, ray, {}, hit(RayHit::Kind::occupied, {8, 4, 9})));
      EXPECT_TRUE(oracle::is_tie(map, ray, {}, hit(RayHit::Kind::occupied, {8, 4, 8})));
      EXPECT_EQ(oracle::is_tie(map, ray, {}, hit(RayHit::Kind::occupied, {7, 4, 8})), x < 8.1);
    }
  }
}

}  // namespace
}  // namespace viewgain
