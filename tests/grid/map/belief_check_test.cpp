// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which beliefs a map takes.

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "core/expect_error.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain {
namespace {

using namespace test;

const GridConfig kConfig{0.01, {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}}, {}, 0.01};

TEST(BeliefCheck, RefusesWhatNoReadingsMake) {
  BeliefGrid grid(kConfig);
  const std::string before = grid.content_hash();
  const float nan = std::numeric_limits<float>::quiet_NaN(), most = 1e30F;
  for (const auto& [part, belief] :
       {std::pair<const char*, Belief>{"nan", {{1, 1, 1, nan, 0, 0}, {}, 1}},
        {"nan", {{1, 1, 1, 0, 0, 0}, {0, nan, 0}, 1}},
        {"-1", {{1, 1, -1, 0, 0, 0}, {}, 1}},
        {"measured points", {{1, 1, 1, 0, 0, 0}, {}, 1U << 31U}},
        // entropy_removed would be NaN
        {"semidefinite", {{1, 1, 1, 1e8F, 0, 0}, {}, 1}},
        {"semidefinite", {{1, 1, 1, 1e8F, 0, 0}, {}, 2147483647}},
        {"semidefinite", {{1, 1, 1, 0, 1.001F, 0}, {}, 1}},
        {"semidefinite", {{1, 1, 1, 0.8F, 0.8F, -0.8F}, {}, 1}},  // each pair alone would do
        {"semidefinite", {{1e12F, 1, 1, 0, 0, 1.001F}, {}, 1}},   // in its own scale
        {"semidefinite", {{0, 1, 1, 0.001F, 0, 0}, {}, 1}},
        // fused points would lie beyond all voxels
        {"too far from its voxel", {{1e-30F, 1e-30F, 1e-30F, 0, 0, 0}, {most, 0, 0}, 3}},
        {"too far from its voxel", {{1e8F, 1e8F, 1e-2F, 0, 0, 0}, {0, 0, 1e5F}, 3}},
        {"too far from its voxel", {{0, 0, 0, 0, 0, 0}, {0, 1, 0}, 0}}}) {
    expect_error(ErrorCode::invalid_argument, part, [&] { grid.set({1, 2, 3}, 1.0F, belief); });
    EXPECT_EQ(grid.content_hash(), before) << part;
  }
}

TEST(BeliefCheck, TakesWhatRoundingAndImportersMake) {
  BeliefGrid grid(kConfig);
  for (const Belief& belief : {Belief{}, Belief{{1e5F, 1e5F, 1e4F, 0, 0, 0}, {0, 0, 20}, 1},
                               Belief{{1e5F, 0, 0, 0, 0, 0}, {}, 1},  // one direction alone
                               Belief{{1e-30F, 1e-30F, 1e-30F, 0, 0, 0}, {}, 1},
                               Belief{{1e38F, 1e38F, 1e38F, 0, 0, 0}, {1e36F, 0, 0}, 1}}) {
    grid.set({1, 2, 3}, 1.0F, belief);
    EXPECT_EQ(grid.belief({1, 2, 3}), belief);
  }
}

bool is_definite(const Belief& belief) {
  return belief.information_matrix().matrix().determinant() > 0 &&
         belief.information_matrix().inverse().xx > 0;
}

// Rounding, of one sum or of many, may have made them indefinite; so little is added that it could
// be rounding, too.
TEST(BeliefCheck, MakesTheIndefiniteDefinite) {
  int cases = 0;
  for (const float off : {1.0F, 1.0000001F, 1.00001F, 1.001F, 1.01F}) {
    for (const float scale : {1e-6F, 1.0F, 1e30F}) {
      const float one = scale, more = off * scale;
      const auto hits = static_cast<std::uint32_t>(0x1p24F * (off - 1) + 1);
      const Belief belief{{one, one, one, more, one, one}, {1e-3F * one, 0, 0}, hits};
      BeliefGrid grid(kConfig);
      grid.set({1, 2, 3}, 1.0F, belief);
      const Belief kept = grid.belief({1, 2, 3}).value();
      EXPECT_TRUE(is_definite(kept)) << off;
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_GE(kept.information[i], belief.information[i]);
        const float most = i < 3 ? (5 * (off - 1) + 1e-6F) * scale : 0.0F;
        EXPECT_LE(kept.information[i], belief.information[i] + most);
      }
      EXPECT_EQ(kept.information_vector, belief.information_vector);
      EXPECT_EQ(kept.hits, hits);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 15);
}

/// Beliefs of a map that its own set() takes; all must be, and positive definite.
std::size_t taken(const BeliefGrid& grid) {
  BeliefGrid other(kConfig);
  std::size_t count = 0;
  grid.for_each_belief([&](Index3 voxel, const Belief& belief) {
    EXPECT_NO_THROW(other.set(voxel, 1.0F, belief));
    EXPECT_TRUE(is_definite(belief));
    ++count;
  });
  return count;
}

// Sigmas that differ by large factors leave information that single precision hardly tells from
// singular, or from indefinite.
TEST(BeliefCheck, TakesAllThatIntegratorsMake) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t beliefs = 0;
  for (const ConstantNoise noise : {ConstantNoise{1e-3, 1e-3},
                                    {1e-6, 1e-1},
                                    {1e-1, 1e-6},
                                    {1e-5, 1e-2},
                                    {1e-7, 1e-7},
                                    {10, 1e-3},
                                    {1e-3, 30}}) {
    Sensor sensor = small_sensor(32, 24);
    sensor.noise = noise;
    BeliefGrid grid(kConfig);
    CloudIntegrator integrator(sensor);
    for (int frame = 0; frame < 40; ++frame) {
      // Many readings a voxel, some frames of one direction.
      const Eigen::Vector3d eye(0.4 + 0.2 * unit(random), frame % 2 == 0 ? 0.0 : unit(random),
                                frame % 2 == 0 ? 0.0 : unit(random));
      std::vector<std::array<double, 3>> points;
      for (int i = 0; i < 3000; ++i) {
        points.push_back({0.03 * unit(random), 0.03 * unit(random), 0.03 * unit(random)});
      }
      integrator.integrate(grid, points, Pose(Eigen::Matrix3d::Identity(), eye));
    }
    beliefs += taken(grid);

    // One reading a voxel, along no axis: rounded, what is singular may be indefinite.
    BeliefGrid sparse(kConfig);
    std::vector<std::array<double, 3>> points;
    for (int i = 0; i < 1000; ++i) {
      points.push_back({0.09 * unit(random), 0.09 * unit(random), 0.09 * unit(random)});
    }
    integrator.integrate(sparse, points, Pose(Eigen::Matrix3d::Identity(), {0.4, 0.3, 0.2}));
    beliefs += taken(sparse);
  }
  EXPECT_GT(beliefs, 1000U);
}

TEST(BeliefCheck, TakesALongStareInOneDirection) {
  // A hundred thousand readings of one voxel: the sums' rounding adds up.
  Sensor sensor = small_sensor(32, 24);
  sensor.noise = ConstantNoise{1.1e-6, 2.3e-2};
  BeliefGrid grid(kConfig);
  CloudIntegrator integrator(sensor);
  const std::vector<std::array<double, 3>> points(20'000, {0.0051, 0.0049, 0.0053});
  for (int frame = 0; frame < 10; ++frame) {
    integrator.integrate(grid, points, Pose(Eigen::Matrix3d::Identity(), {0.31, 0.17, 0.23}));
  }
  EXPECT_EQ(grid.belief({0, 0, 0}).value().hits, 200'000U);
  EXPECT_EQ(taken(grid), 1U);
}

}  // namespace
}  // namespace viewgain
