// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface gains over all hazards that can be meant, from 1e-8 to 1e3 per metre and a rate of 0,
// against double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "oracle/surface.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using test::kExactVoxel;

constexpr Index3 kDims{64, 16, 16};
constexpr std::array kRates{1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3};

/// A map whose planes of voxels across x are as `state_at(x)` says.
BeliefGrid planes(const std::function<VoxelState(int)>& state_at) {
  std::vector<std::uint8_t> states;
  for (int x = 0; x < kDims.x; ++x) {
    states.insert(states.end(), static_cast<std::size_t>(kDims.y * kDims.z),
                  static_cast<std::uint8_t>(state_at(x)));
  }
  GridConfig config;
  config.voxel_size = kExactVoxel;
  config.workspace = test::sparse_map(kDims, {}).workspace();
  config.prior_sigma = 0.5 * kExactVoxel;
  return BeliefGrid::from_states(config, states);
}

/// Free, but for unknown planes from 20 to 29, a gap at 24 and a wall at 30 that is seen from
/// behind, or from the front if all beyond it is unknown. The wall was measured once.
BeliefGrid wall_behind_slabs(bool from_behind) {
  BeliefGrid grid = planes([=](int x) {
    if (x == 30) return VoxelState::occupied;
    const bool is_slab = x >= 20 && x < 30 && x != 24;
    return is_slab || (!from_behind && x > 30) ? VoxelState::unknown : VoxelState::free;
  });
  Belief belief;
  belief.hits = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    belief.information[k] = static_cast<float>(1 / (kExactVoxel * kExactVoxel));
  }
  std::vector<BeliefGrid::VoxelValue> wall;
  grid.for_each_occupied([&](const BeliefGrid::VoxelValue& value) {
    wall.push_back({value.voxel, value.log_odds, belief});
  });
  grid.set(wall);
  return grid;
}

/// The same rate everywhere, in cells of 2^shift voxels.
HazardConfig constant(int shift, double rate) {
  return {
      .model = HazardConfig::Model::constant(
          rate, 4 * kExactVoxel * (1 << shift) / HazardConfig::Model::for_size(1).decay_length)};
}

/// By voxel: half of the rates 0, the others of all sizes from 1e-6 to 1e4 [1/m].
HazardConfig of_all_sizes(const BeliefGrid& grid, test::Random& random) {
  HazardConfig::Volume volume;
  volume.box = VoxelBox::from_dims(grid.min_index(), grid.dims());
  volume.rates.resize(volume.box.volume());
  for (float& rate : volume.rates) {
    const double size = test::uniform(random, -6, 4);
    rate = test::uniform_int(random, 0, 1) == 0 ? 0.0F : static_cast<float>(std::pow(10, size));
  }
  return {.volume = std::make_shared<const HazardConfig::Volume>(std::move(volume))};
}

/// Some pixels of a camera before the slabs, none of whose rays lies in a plane of the lattice.
Sensor some_rays() {
  Sensor sensor = test::lattice_sensor(13, 11);
  sensor.camera.fx = sensor.camera.fy = 60;
  return sensor;
}
std::vector<Pose> poses() {
  std::vector<Pose> all;
  for (const double y : {5.3, 8.6, 11.7}) {
    const Eigen::Vector3d eye(-13.4, y, 7.1), at(30, 8.2, 8.9);
    all.push_back(look_at(kExactVoxel * eye, kExactVoxel * at, {0.1, 0.2, 1}));
  }
  return all;
}

// A ray through unknown space to a wall that is seen from behind ends in that space for certain,
// however low the hazard is.
TEST(SurfaceHazards, AWallFromBehindIsCertainByAnyRate) {
  const BeliefGrid grid = planes([](int x) {
    return x == 30             ? VoxelState::occupied
           : x >= 10 && x < 30 ? VoxelState::unknown
                               : VoxelState::free;
  });
  Sensor sensor = test::lattice_sensor(1, 1);
  const double cap = std::numbers::pi * kExactVoxel * kExactVoxel / 2;
  for (const double rate : kRates) {
    for (int shift = 0; shift < 4; ++shift) {
      const auto scene = VoxelScene::build(grid, {}, {}, constant(shift, rate));
      const GainEvaluator evaluator(scene, sensor, {.model = GainModel::surface});
      const Pose pose = test::axis_pose({-30, 8.5, 8.5}, 0, true);
      EXPECT_NEAR(evaluator.evaluate(pose).gain, cap, 1e-5 * cap) << rate << ", " << shift;
      double chance = 0;
      for (const VoxelContribution& part : evaluator.contributions(pose)) {
        chance += part.expected_rays;
      }
      EXPECT_NEAR(chance, 1, 1e-9);
    }
  }
}

TEST(SurfaceHazards, RatesOfAllSizesAgreeWithDoublePrecision) {
  const Sensor sensor = some_rays();
  std::size_t checks = 0;
  for (const bool from_behind : {true, false}) {
    const BeliefGrid grid = wall_behind_slabs(from_behind);
    const oracle::DenseMap map(grid);
    for (const double rate : kRates) {
      for (int shift = 0; shift < 4; ++shift) {
        const HazardConfig config = constant(shift, rate);
        const HazardField hazard(grid.snapshot(), config);
        for (const std::string& isa : available_isas()) {
          const test::ScopedIsa scoped(isa);
          const GainEvaluator evaluator(VoxelScene::build(grid, {}, {}, config), sensor,
                                        {.model = GainModel::combined});
          for (const Pose& pose : poses()) {
            SCOPED_TRACE(std::to_string(rate) + ", " + std::to_string(shift) + ", " + isa);
            const oracle::SurfaceValue expected =
                oracle::surface_value(grid, map, hazard, sensor, {}, pose);
            const ViewGain actual = evaluator.evaluate(pose);
            EXPECT_GT(expected.area, 0);
            EXPECT_NEAR(actual.area, expected.area, 2e-5 * expected.area);
            // What little passes is added to what is known: rounded to 1e-13 nat.
            EXPECT_NEAR(actual.refinement_saturated, expected.refinement_saturated,
                        2e-5 * expected.refinement_saturated + 1e-13);
            ++checks;
          }
        }
      }
    }
  }
  EXPECT_EQ(checks, 2 * kRates.size() * 4 * 3 * available_isas().size());
}

// Refinement behind unknown space of great depth: what passes is small, and right.
TEST(SurfaceHazards, WhatPassesDeepSpaceIsAsExactAsWhatEndsThere) {
  const BeliefGrid grid = wall_behind_slabs(false);
  const oracle::DenseMap map(grid);
  for (const double depth : {0.5, 5.0, 15.0, 30.0}) {
    const HazardConfig config = constant(0, depth / (9 * kExactVoxel));
    const HazardField hazard(grid.snapshot(), config);
    const GainEvaluator evaluator(VoxelScene::build(grid, {}, {}, config), some_rays(),
                                  {.model = GainModel::combined});
    for (const Pose& pose : poses()) {
      const double expected =
          oracle::surface_value(grid, map, hazard, some_rays(), {}, pose).refinement_saturated;
      EXPECT_GT(expected, 0);
      // Rounded as above.
      EXPECT_NEAR(evaluator.evaluate(pose).refinement_saturated, expected, 1e-4 * expected + 1e-13)
          << depth;
    }
  }
}

TEST(SurfaceHazards, ContributionsAddUpByRatesOfAllSizes) {
  std::size_t views = 0, gaining = 0;
  for (const test::MapFamily family :
       {test::MapFamily::salt_and_pepper_30, test::MapFamily::tiles_8, test::MapFamily::rotated}) {
    test::Random random(61 + static_cast<unsigned>(family));
    const test::RandomMap made = test::random_map(family, random);
    const Sensor sensor = test::random_sensor(made.grid, random);
    const HazardConfig hazard = of_all_sizes(made.grid, random);
    const GainEvaluator evaluator(VoxelScene::build(made.grid, {}, {}, hazard), sensor,
                                  {.model = GainModel::surface});
    for (const Pose& pose : test::random_poses(made, 40, random)) {
      const ViewGain gain = evaluator.evaluate(pose);
      if (gain.status != ViewGain::Status::ok) continue;
      double sum = 0;
      for (const VoxelContribution& part : evaluator.contributions(pose)) sum += part.gain;
      EXPECT_NEAR(sum, gain.gain, 1e-5 * gain.gain);
      ++views;
      gaining += sum > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(views, 80U);
  EXPECT_GT(gaining, views / 3);
}

// The same by a map with many walls that are seen from behind.
TEST(SurfaceHazards, VolumesOfAllSizesAgreeWithDoublePrecision) {
  test::Random random(5);
  const Sensor sensor = some_rays();
  for (int i = 0; i < 8; ++i) {
    const BeliefGrid grid = wall_behind_slabs(i % 4 != 3);
    const oracle::DenseMap map(grid);
    const HazardConfig config = of_all_sizes(grid, random);
    const HazardField hazard(grid.snapshot(), config);
    const GainEvaluator evaluator(VoxelScene::build(grid, {}, {}, config), sensor,
                                  {.model = GainModel::surface});
    for (const Pose& pose : poses()) {
      const double expected = oracle::surface_value(grid, map, hazard, sensor, {}, pose).area;
      EXPECT_NEAR(evaluator.evaluate(pose).area, expected, 2e-5 * expected);
    }
  }
}

// A rate of 0 says that nothing is there: the surface before a wall from behind is in the rest of
// the stretch, and nowhere if there is no rest.
TEST(SurfaceHazards, ARateOfZeroHoldsNoSurface) {
  const BeliefGrid grid = wall_behind_slabs(true);
  const GainConfig config{.model = GainModel::combined};
  const Pose pose = test::axis_pose({-30, 8.5, 8.5}, 0, true);
  const double cap = std::numbers::pi * kExactVoxel * kExactVoxel / 2;
  for (const int first : {25, 28, 29, 30}) {
    HazardConfig::Volume volume;
    volume.box = VoxelBox::from_dims({0, 0, 0}, kDims);
    for (int x = 0; x < kDims.x; ++x) {
      volume.rates.insert(volume.rates.end(), std::size_t{256}, x >= first ? 1e-8F : 0.0F);
    }
    const HazardConfig hazard{.volume = std::make_shared<const HazardConfig::Volume>(volume)};
    const GainEvaluator evaluator(VoxelScene::build(grid, {}, {}, hazard),
                                  test::lattice_sensor(1, 1), config);
    const ViewGain gain = evaluator.evaluate(pose);
    EXPECT_NEAR(gain.area, first < 30 ? cap : 0, 1e-5 * cap) << first;
    EXPECT_EQ(gain.refinement_saturated, 0);
    for (const VoxelContribution& part : evaluator.contributions(pose)) {
      EXPECT_EQ(part.gain > 0, part.voxel.x >= first && part.voxel.x < 30) << part.voxel.x;
    }
  }
}

}  // namespace
}  // namespace viewgain
