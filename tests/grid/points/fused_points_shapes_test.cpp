// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface points on curved surfaces, beside large unknown tiles, and of beliefs that make no sense.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random_values.hpp"
#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

Vector3d vector(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

/// From where unknown voxels are round a point's to where free ones are, voxel by voxel.
Vector3d free_side(const BeliefGrid& grid, const FusedPoint& point) {
  const VoxelBox workspace = VoxelBox::from_dims(grid.min_index(), grid.dims());
  const Vector3d at = vector(point.position) / grid.voxel_size();
  Vector3d side = Vector3d::Zero();
  for_each_voxel(VoxelBox{{-3, -3, -3}, {4, 4, 4}}, [&](Index3 off) {
    const Index3 v{static_cast<std::int32_t>(std::floor(at.x())) + off.x,
                   static_cast<std::int32_t>(std::floor(at.y())) + off.y,
                   static_cast<std::int32_t>(std::floor(at.z())) + off.z};
    if (!workspace.contains(v)) return;
    const VoxelState state = grid.state(v);
    if (state == VoxelState::free) side += Vector3d(off.x, off.y, off.z);
    if (state == VoxelState::unknown) side -= Vector3d(off.x, off.y, off.z);
  });
  return side;
}

/// How many points there are, of which more than so many have a free side.
std::size_t check_free_sides(const BeliefGrid& grid, std::size_t with_side) {
  FusedPointsConfig config;
  config.per_voxel = true;  // so that each point is its voxel's centre
  const std::vector<FusedPoint> points = fused_points(grid, config);
  std::size_t compared = 0;
  for (const FusedPoint& point : points) {
    const double along = free_side(grid, point).dot(vector(point.toward_free));
    EXPECT_GE(along, 0) << vector(point.position).transpose();
    if (along > 0) ++compared;
  }
  EXPECT_GT(compared, with_side);
  return points.size();
}

// A hall of 20 x 20 x 3 m at 1 cm, whose unknown parts are tiles of three sizes. The side of free
// space is found by asking the map for every voxel around each point.
TEST(FusedPointsShapes, FreeSideBesideLargeUnknownTiles) {
  BeliefGrid grid({0.01, {{-10, -10, 0}, {10, 10, 3}}, {}, 0.01});
  RandomValues random(5);
  const auto put = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    grid.set({x, y, z}, 2.0F, Belief{{1e5F, 1e5F, 1e5F, 0, 0, 0}, {0, 0, 0}, 5});
  };
  // Walls with a known free layer before them, at the borders of blocks, nodes and their parents.
  int patches = 0;
  for (const std::int32_t face : {-1000, -896, -513, 0, 8, 127, 128, 640, 900}) {
    for (const std::int32_t z : {0, 120, 250}) {
      for (std::int32_t y = -3; y <= 3; ++y) {
        for (std::int32_t k = 0; k < 7; ++k) {
          put(face, y + face / 2, z + k);
          for (std::int32_t free = 1; free <= 4; ++free) {
            grid.set({face + free, y + face / 2, z + k}, -1.0F);
          }
        }
      }
      ++patches;
    }
  }
  ASSERT_EQ(patches, 27);
  EXPECT_EQ(check_free_sides(grid, 1200), 27U * 49U);
}

TEST(FusedPointsShapes, TheFreeSideIsThatOfAllVoxelsAround) {
  RandomValues random(5);
  BeliefGrid grid({0.01, {{0.03, -0.05, 0}, {0.27, 0.17, 0.29}}, {}, 0.01});
  test::for_each_voxel(grid, [&](Index3 voxel) {
    const double dice = random.uniform(0, 1);
    if (dice < 0.5) grid.set(voxel, -1);
    if (dice > 0.8) grid.set(voxel, 1, Belief{{1e6F, 2e6F, 3e6F, 0, 0, 0}, {}, 4});
  });
  (void)check_free_sides(grid, 2500);
}

// Two layers of a wall at each face of the workspace, free space before them, pooled by one and by
// two voxels. Its points look into the workspace, as nothing is known to lie beyond.
TEST(FusedPointsShapes, WallsAtTheWorkspacesFacesLookInwards) {
  constexpr double kVoxel = 0.01;
  constexpr std::array<std::int32_t, 3> kDims{19, 22, 27};
  std::size_t points_seen = 0;
  for (const bool coarse : {false, true}) {
    for (int face = 0; face < 6; ++face) {
      const auto axis = static_cast<std::size_t>(face / 2);
      Vector3d inward = Vector3d::Zero();
      inward[face / 2] = face % 2 == 0 ? 1 : -1;
      BeliefGrid grid({kVoxel, {{0.03, -0.05, 0}, {0.22, 0.17, 0.27}}, {}, 0.01});
      const Index3 from = grid.min_index();
      const float information = coarse ? 1 / (0.02F * 0.02F) : 1e5F;
      for (std::int32_t i = 0; i < kDims[0] * kDims[1] * kDims[2]; ++i) {
        const std::array at{i / kDims[2] / kDims[1], i / kDims[2] % kDims[1], i % kDims[2]};
        const std::int32_t depth = face % 2 == 0 ? at[axis] : kDims[axis] - 1 - at[axis];
        const Index3 voxel{from.x + at[0], from.y + at[1], from.z + at[2]};
        if (depth < 2) {
          grid.set(voxel, 2.0F,
                   Belief{{information, information, information, 0, 0, 0}, {0, 0, 0}, 1});
        } else if (depth < 12) {
          grid.set(voxel, -1.0F);
        }
      }
      EXPECT_EQ(pooling_of(grid.snapshot()).shift, coarse ? 1 : 0);
      for (const FusedPoint& point : fused_points(grid)) {
        ++points_seen;
        EXPECT_GT(vector(point.toward_free).dot(inward), 0.7) << face << ' ' << coarse;
      }
    }
  }
  EXPECT_GT(points_seen, 1000U);
}

// Numbers that no reading makes, as far as `set` takes them: none may cost more than another, nor
// spoil the points beside it.
TEST(FusedPointsShapes, BeliefsFarFromTheirVoxelMakeNoPoint) {
  const float most = std::numeric_limits<float>::max(), least = 1e-40F;
  const std::vector<Belief> strange{
      {{1e-30F, 1e-30F, 1e-30F, 0, 0, 0}, {1e30F, 0, 0}, 3},
      {{1e-30F, 1e-30F, 1e-30F, 0, 0, 0}, {-1e30F, 1e30F, 1e30F}, 2147483647U},
      {{1, 1, 1, 0, 0, 0}, {0, 0, 1e9F}, 3},      // 1e11 voxels
      {{1, 1, 1, 0, 0, 0}, {1e5F, -1e6F, 0}, 3},  // 1e8 voxels
      {{1, 1, 1, 0, 0, 0}, {0, 0, -0.3F}, 3},
      {{1, 1, 1, 0, 0, 0}, {0.3F, 0, 0}, 3},  // 30 voxels
      {{least, least, least, 0, 0, 0}, {most, most, -most}, 3},
      {{0, 0, 0, 0, 0, 0}, {1, 0, 0}, 3},
      {{most, 0, most, 0, 0, 0}, {0, 1, 0}, 3}};
  std::size_t cases = 0, refused = 0;
  for (const Belief& belief : strange) {
    for (const bool per_voxel : {false, true}) {
      BeliefGrid grid({0.01, {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}}, {}, 0.01});
      try {
        grid.set({0, 0, 0}, 0.85F, belief);
      } catch (const Error&) {
        ++refused;
        continue;
      }
      for (std::int32_t x = -4; x < 4; ++x) {
        for (std::int32_t y = -4; y < 4; ++y) {
          grid.set({x, y, 40}, 2.0F, Belief{{1e5F, 1e5F, 1e5F, 0, 0, 0}, {0, 0, 0}, 5});
        }
      }
      FusedPointsConfig config;
      config.per_voxel = per_voxel;
      const std::vector<FusedPoint> points = fused_points(grid, config);
      EXPECT_EQ(points.size(), 64U) << cases;
      for (const FusedPoint& point : points) EXPECT_NEAR(point.position[2], 0.405, 1e-6);
      ++cases;
    }
  }
  EXPECT_GE(cases, 4U);
  EXPECT_EQ(cases + refused, 18U);
}

// A well seen plate of 12 x 12 voxels and, 3 voxels beyond its rim, a row of 12 that was hit so
// often by readings with this sigma [m].
BeliefGrid plate_and_row(std::uint32_t hits_of_row, double sigma_of_row) {
  BeliefGrid grid({0.01, {{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}, {}, 0.01});
  const auto put = [&](std::int32_t x, std::int32_t y, std::uint32_t hits, double sigma) {
    const auto information = static_cast<float>(hits / (sigma * sigma));
    grid.set({x, y, 0}, 2.0F,
             Belief{{information, information, information, 0, 0, 0}, {0, 0, 0}, hits});
  };
  for (std::int32_t x = -6; x < 6; ++x) {
    for (std::int32_t y = -6; y < 6; ++y) put(x, y, 20, 0.003);
    put(x, 8, hits_of_row, sigma_of_row);
  }
  return grid;
}

TEST(FusedPointsShapes, HaloBesideAWellSeenSurfaceIsLeftOut) {
  const auto halo = [](const std::vector<FusedPoint>& points) {
    return std::count_if(points.begin(), points.end(),
                         [](const FusedPoint& p) { return p.position[1] > 0.075; });
  };
  const BeliefGrid grid = plate_and_row(4, 0.003);  // columns of 12 hits beside those of 100
  FusedPointsConfig all;
  all.min_relative_evidence = 0;
  EXPECT_EQ(fused_points(grid, all).size(), 156U);
  EXPECT_EQ(halo(fused_points(grid, all)), 12);
  FusedPointsConfig tenth;
  tenth.min_relative_evidence = 0.1;
  EXPECT_EQ(halo(fused_points(grid, tenth)), 12);
  EXPECT_EQ(fused_points(grid).size(), 144U);
  EXPECT_EQ(halo(fused_points(grid)), 0);
}

TEST(FusedPointsShapes, WhatWasSeenFromAfarStaysBesideWhatWasSeenFromNear) {
  // Three times as far: a ninth of the readings, each of which stands for nine times the area. As
  // few readings from near are the halo of the test above.
  EXPECT_EQ(fused_points(plate_and_row(4, 0.009)).size(), 156U);
}

// Over what length readings are pooled: closed forms.

// A map with `count` voxels that were read from random directions, some of them once, some often.
BeliefGrid read_from_afar(double voxel, double sigma_axial, double sigma_lateral, int count) {
  BeliefGrid grid({voxel, {{0, 0, 0}, {64 * voxel, 64 * voxel, 64 * voxel}}, {}, 0.01});
  RandomValues random(11);
  const double a = std::pow(sigma_lateral, -2), b = std::pow(sigma_axial, -2);
  for (int i = 0; i < count; ++i) {
    const Vector3d d = random.rotation().col(0);
    const std::uint32_t hits = 1 + static_cast<std::uint32_t>(i % 5);
    const Eigen::Matrix3d L =
        hits * (a * Eigen::Matrix3d::Identity() + (b - a) * d * d.transpose());
    const auto f = [&](int r, int c) { return static_cast<float>(L(r, c)); };
    const std::int32_t x = i % 64, y = i / 64 % 64, z = i % 7;
    grid.set({x, y, z}, 0.85F,
             Belief{{f(0, 0), f(1, 1), f(2, 2), f(0, 1), f(0, 2), f(1, 2)}, {0, 0, 0}, hits});
  }
  return grid;
}

TEST(Pooling, TheFootprintIsTheSigmaAcrossTheRay) {
  for (const double lateral : {0.001, 0.0018, 0.004}) {
    for (const double ratio : {0.2, 0.9, 1.0, 2.0, 8.0}) {  // axial over lateral, either way
      const BeliefGrid grid = read_from_afar(lateral / 1.2, ratio * lateral, lateral, 300);
      const Pooling pooling = pooling_of(grid.snapshot());
      EXPECT_EQ(pooling.shift, 0);
      EXPECT_NEAR(pooling.length, lateral, 2e-3 * lateral) << ratio;
    }
  }
}

TEST(Pooling, CubesAreAboutAsLargeAsTheFootprint) {
  struct Case {
    double voxel;
    int shift;
    double length;
  };
  for (const Case& c : {Case{0.01, 0, 0.01}, Case{0.003125, 0, 0.003125}, Case{0.0015, 0, 0.0018},
                        Case{0.001, 1, 0.002}, Case{0.0005, 2, 0.002}, Case{0.0004, 2, 0.0018},
                        Case{0.0001, 3, 0.0018}}) {
    const Pooling pooling = pooling_of(read_from_afar(c.voxel, 0.0036, 0.0018, 300).snapshot());
    EXPECT_EQ(pooling.shift, c.shift) << c.voxel;
    EXPECT_NEAR(pooling.length, c.length, 1e-5) << c.voxel;
  }
}

TEST(Pooling, AMapWithoutReadingsHasItsVoxels) {
  const GridConfig config{0.001, {{-0.04, -0.04, -0.04}, {0.04, 0.04, 0.04}}, {}, 0.01};
  const Pooling pooling = pooling_of(BeliefGrid(config).snapshot());
  EXPECT_EQ(pooling.shift, 0);
  EXPECT_EQ(pooling.length, 0.001);
}

}  // namespace
}  // namespace viewgain
