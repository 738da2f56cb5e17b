// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/expect_error.hpp"
#include "oracle/surface.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain {
namespace {

constexpr double kVoxel = 0.01;  // [m]

BeliefGrid grid_of(Index3 dims) {
  GridConfig config;
  config.voxel_size = kVoxel;
  config.workspace = {{-0.13, 0.07, -1.0},
                      {-0.13 + dims.x * kVoxel, 0.07 + dims.y * kVoxel, -1.0 + dims.z * kVoxel}};
  config.prior_sigma = 0.01;
  return BeliefGrid(config);
}

// `hits` readings with this sigma [m].
void put(BeliefGrid& grid, Index3 voxel, std::uint32_t hits, double sigma = 0.005) {
  Belief belief;
  const auto information = static_cast<float>(hits / (sigma * sigma));
  belief.information = {information, information, information, 0, 0, 0};
  belief.hits = hits;
  grid.set(voxel, 1.0F, belief);
}

Index3 any_voxel(const BeliefGrid& grid, std::mt19937& random) {
  const Index3 base = grid.min_index();
  const auto any = [&](int size) {
    return std::uniform_int_distribution<int>(0, size - 1)(random);
  };
  return {base.x + any(grid.dims().x), base.y + any(grid.dims().y), base.z + any(grid.dims().z)};
}

TEST(HazardField, DistancesAreThoseOfBruteForce) {
  std::mt19937 random(7);
  std::size_t checks = 0, finite = 0;
  for (int shift = 0; shift < 4; ++shift) {
    BeliefGrid grid = grid_of({41, 29, 35});
    const auto voxel = [&] { return any_voxel(grid, random); };
    for (int k = 0; k < 5; ++k) put(grid, voxel(), 3);
    for (int k = 0; k < 50; ++k) {  // too little evidence
      const Index3 v = voxel();
      if (!grid.belief(v)) put(grid, v, 2);
    }
    const HazardConfig::Model model{30.0, 4 * kVoxel * (1 << shift), 0.5};
    const HazardField field(grid.snapshot(), {.model = model});
    ASSERT_EQ(field.cell_shift(), shift);
    for (int k = 0; k < 2000; ++k) {
      const Index3 v = voxel();
      const double expected = oracle::distance_to_evidence(grid, shift, v);
      ++checks;
      if (expected > HazardConfig::Model::kCut * model.decay_length + 1e-9) {
        EXPECT_TRUE(std::isinf(field.distance(v)));
        EXPECT_EQ(field.rate(v), 0.5F);
        EXPECT_TRUE(field.is_new(v));
        continue;
      }
      ++finite;
      EXPECT_NEAR(field.distance(v), expected, 1e-12);
      EXPECT_NEAR(field.rate(v), 0.5 + 30.0 * std::exp(-expected / model.decay_length), 1e-5);
      EXPECT_EQ(field.is_new(v), expected > 2 * kVoxel + 1e-9);
    }
  }
  EXPECT_EQ(checks, 8000U);
  EXPECT_GT(finite, 3000U);
}

TEST(HazardField, VoxelsFinerThanTheFootprintCountTogether) {
  std::mt19937 random(17);
  std::size_t checks = 0, finite = 0, single = 0;
  for (int pooling = 0; pooling < 4; ++pooling) {
    const double footprint = 1.2 * kVoxel * (1 << pooling);
    BeliefGrid grid = grid_of({41, 29, 35});
    const auto voxel = [&] { return any_voxel(grid, random); };
    for (int k = 0; k < 150; ++k) put(grid, voxel(), 1, footprint);
    const HazardConfig::Model model{30.0, 8 * kVoxel, 0.5};
    const HazardField field(grid.snapshot(), {.model = model});
    ASSERT_EQ(field.pooling().shift, pooling);
    for (int k = 0; k < 1000; ++k) {
      const Index3 v = voxel();
      const double expected =
          oracle::distance_to_evidence(grid, field.cell_shift(), v, field.pooling().shift);
      ++checks;
      if (pooling == 0) single += std::isinf(expected);
      if (expected > HazardConfig::Model::kCut * model.decay_length + 1e-9) {
        EXPECT_TRUE(std::isinf(field.distance(v)));
        continue;
      }
      ++finite;
      EXPECT_NEAR(field.distance(v), expected, 1e-12);
      EXPECT_EQ(field.is_new(v), expected > 2 * footprint + 1e-9);
    }
  }
  EXPECT_EQ(checks, 4000U);
  EXPECT_EQ(single, 1000U);  // one hit a voxel is no evidence by itself
  EXPECT_GT(finite, 1500U);
}

TEST(HazardField, WithoutEvidenceEverythingIsFar) {
  const BeliefGrid grid = grid_of({16, 16, 70});
  const HazardField field(grid.snapshot());
  const HazardConfig::Model model =
      HazardConfig::Model::for_size(0.7);  // the workspace's longest side
  EXPECT_NEAR(field.model().near_rate, model.near_rate, 1e-9);
  EXPECT_NEAR(field.model().decay_length, model.decay_length, 1e-12);
  EXPECT_EQ(field.rate(grid.min_index()), static_cast<float>(field.model().far_rate));
  EXPECT_TRUE(field.is_new(grid.min_index()));
  EXPECT_TRUE(std::isinf(field.distance({1'000'000, 0, 0})));
}

TEST(HazardField, TheSizeIsThatOfTheEvidenceUnlessGiven) {
  BeliefGrid grid = grid_of({64, 64, 64});
  const Index3 base = grid.min_index();
  put(grid, {base.x + 10, base.y + 10, base.z + 10}, 5);
  put(grid, {base.x + 29, base.y + 12, base.z + 10}, 5);
  EXPECT_NEAR(HazardField(grid.snapshot()).model().decay_length, 0.07 * 0.20, 1e-12);
  EXPECT_NEAR(HazardField(grid.snapshot(), {.object_size = 0.5}).model().decay_length, 0.035,
              1e-12);
}

TEST(HazardField, RatesFromElsewhere) {
  BeliefGrid grid = grid_of({16, 16, 16});
  const Index3 base = grid.min_index();
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = VoxelBox::from_dims({base.x + 2, base.y, base.z}, {2, 3, 4});
  for (int i = 0; i < 24; ++i) volume->rates.push_back(static_cast<float>(i));
  volume->outside = 100;
  const HazardField field(grid.snapshot(), {.volume = volume});
  EXPECT_EQ(field.cell_shift(), 0);
  EXPECT_EQ(field.rate({base.x + 3, base.y + 2, base.z + 1}), 21.0F);
  EXPECT_EQ(field.rate({base.x + 4, base.y + 2, base.z + 1}), 100.0F);
}

TEST(HazardField, RefusesWhatIsOutOfBounds) {
  const GridSnapshot snapshot = grid_of({8, 8, 8}).snapshot();
  const auto refuses = [&](const char* what, const HazardConfig& config) {
    test::expect_error(ErrorCode::invalid_argument, what,
                       [&] { (void)HazardField(snapshot, config); });
  };
  refuses("object size 0", {.object_size = 0.0});
  refuses("object size nan", {.object_size = std::nan("")});
  refuses("decay length", {.model = HazardConfig::Model{1.0, 0.0, 1.0}});
  refuses("rate near the surface -1", {.model = HazardConfig::Model{-1.0, 0.1, 1.0}});
  refuses("rate far from the surface inf", {.model = HazardConfig::Model{1.0, 0.1, HUGE_VAL}});
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = VoxelBox::from_dims({0, 0, 0}, {2, 2, 2});
  refuses("0 rates for a box of 8 voxels", {.volume = volume});
  auto negative = std::make_shared<HazardConfig::Volume>(*volume);
  negative->rates.assign(8, -1.0F);
  refuses("rate -1", {.volume = negative});
}

}  // namespace
}  // namespace viewgain
