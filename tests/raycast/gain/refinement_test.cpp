// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What sharpening known surface is worth to the combined gain: by hand on plates, and against what
// frames then bring.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "oracle/dense_map.hpp"
#include "oracle/surface.hpp"
#include "raycast/scene_makers.hpp"
#include "raycast/scorer/scorer_scene.hpp"

namespace viewgain {
namespace {

using test::kExactVoxel;

constexpr double kSigma = 0.5 * kExactVoxel;      // of a reading, in all directions [m]
constexpr double kKnown = 3 / (kSigma * kSigma);  // of each voxel's readings [1/m²]

Sensor one_ray() {
  Sensor sensor = test::lattice_sensor(1, 1);
  sensor.noise = ConstantNoise{.sigma_axial = kSigma, .sigma_lateral = kSigma};
  return sensor;
}

// Occupied voxels with equal readings, `across` × `across` of them in each of `layers` planes
// across x, the middle of the first at (30, 8, 8); all else is free.
BeliefGrid plate(int across, int layers = 1) {
  BeliefGrid grid = test::sparse_map({64, 16, 16}, {});
  const std::vector<std::uint8_t> free(64 * 16 * 16, static_cast<std::uint8_t>(VoxelState::free));
  grid.update_box(VoxelBox::from_dims(grid.min_index(), grid.dims()), free);
  Belief belief;
  belief.information = {
      static_cast<float>(kKnown), static_cast<float>(kKnown), static_cast<float>(kKnown), 0, 0, 0};
  belief.hits = 3;
  const int half = across / 2;
  for (int x = 30; x < 30 + layers; ++x) {
    for (int y = 8 - half; y <= 8 + half; ++y) {
      for (int z = 8 - half; z <= 8 + half; ++z) grid.set({x, y, z}, 2.0F, belief);
    }
  }
  return grid;
}

double refinement_of(const BeliefGrid& grid, const GainConfig& config = {}) {
  const GainEvaluator evaluator(VoxelScene::build(grid), one_ray(), config);
  return evaluator.evaluate(test::axis_pose({-30, 8.5, 8.5}, 0, true)).refinement_saturated;
}

// m voxels with readings round the one that the ray ends in.
double expected_of(const BeliefGrid& grid, int m) {
  const double prior = 1 / (9 * grid.prior_sigma() * grid.prior_sigma());
  const double floor = 9 * kExactVoxel * kExactVoxel;
  const auto entropy = [&](double information) { return 1.5 * std::log(1 / information + floor); };
  const double before = prior + m * kKnown / 9;
  return std::min(1.0, m / 9.0) * (entropy(before) - entropy(before + 1 / (kSigma * kSigma)));
}

TEST(Refinement, IsThatOfThePointThatPoolsTheVoxelsAround) {
  int checks = 0;
  for (const auto& [across, layers, m] :
       {std::array{1, 1, 1}, std::array{3, 1, 9}, std::array{7, 1, 9}, std::array{1, 2, 2},
        std::array{3, 2, 18}, std::array{7, 3, 18}}) {
    const BeliefGrid grid = plate(across, layers);
    const double expected = expected_of(grid, m);
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(refinement_of(grid), expected, 1e-6 * expected) << across << ", " << layers;
    // Its weight is 1: it is in the unit of new surface, of which there is none.
    const GainEvaluator evaluator(VoxelScene::build(grid), one_ray());
    const ViewGain gain = evaluator.evaluate(test::axis_pose({-30, 8.5, 8.5}, 0, true));
    EXPECT_EQ(gain.area, 0);
    EXPECT_EQ(gain.gain, gain.refinement_saturated);
    ++checks;
  }
  EXPECT_EQ(checks, 6);
}

// Cells hold four voxels of the plate each.
TEST(Refinement, IsTheSameByLargerCells) {
  BeliefGrid grid = plate(15);
  const double expected = refinement_of(grid);
  for (int scale = 1; scale < 3; ++scale) {
    EXPECT_GT(grid.resample(grid.workspace(), scale), 0U);
    EXPECT_NEAR(refinement_of(grid), expected, 1e-6 * expected) << scale;
  }
}

TEST(Refinement, FallsAsReadingsAdd) {
  BeliefGrid grid = plate(7);
  double before = refinement_of(grid);
  for (int view = 0; view < 6; ++view) {
    grid.for_each_belief([&](Index3 voxel, const Belief& known) {
      Belief more = known;
      for (float& part : more.information) part *= 2;
      grid.set(voxel, 2.0F, more);
    });
    const double after = refinement_of(grid);
    EXPECT_LT(after, 0.7 * before);
    before = after;
  }
}

// What views promise of known surface, and what their frames then take off the entropy of the
// points there.
TEST(Refinement, KeepsItsPromise) {
  const test::ScorerScene scene;
  const ScorerConfig config = scene.config();
  double promised = 0, kept = 0;
  std::size_t voxels = 0;
  for (const std::size_t first : {0, 3}) {
    ViewScorer scorer(scene.sensor, config, {1});
    scorer.add(scene.see(scene.poses[first]), scene.poses[first]);
    for (std::size_t view = 1; view < 7; ++view) {
      const Pose& pose = scene.poses[(first + 5 * view) % scene.poses.size()];
      promised += scorer.evaluate(std::span(&pose, 1)).front().refinement_saturated;
      const std::vector<VoxelContribution> parts = scorer.evaluator()->contributions(pose);
      const BeliefGrid grid = scorer.grid().clone();
      scorer.add(scene.see(pose, view), pose);
      const oracle::DenseMap map(grid), map_after(scorer.grid());
      const double floor = config.voxel_size * config.voxel_size;
      for (const VoxelContribution& part : parts) {
        if (part.state != VoxelState::occupied || !(part.gain > 0)) continue;
        const oracle::Pool before = oracle::pool_of(grid, map, part.voxel);
        const oracle::Pool after = oracle::pool_of(scorer.grid(), map_after, part.voxel);
        kept += oracle::pooled_entropy(before, grid.prior_sigma(), floor) -
                oracle::pooled_entropy(after, grid.prior_sigma(), floor);
        ++voxels;
      }
    }
  }
  EXPECT_GT(voxels, 1000U);
  EXPECT_GT(promised, 30);
  EXPECT_GT(kept, 0.7 * promised) << promised << " nat";
  EXPECT_LT(kept, 1.5 * promised) << promised << " nat";
}

}  // namespace
}  // namespace viewgain
