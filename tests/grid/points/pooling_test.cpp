// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Over what length readings are pooled: closed forms.

#include "viewgain/grid/pooling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random_values.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {
namespace {

using namespace test;
using Eigen::Vector3d;

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
