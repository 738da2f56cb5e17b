// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The hazard at single voxels against the field of the whole map.

#include "viewgain/grid/hazard_probe.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "grid/hazard/cut_grid.hpp"

namespace viewgain {
namespace {

using test::kVoxel;

Belief hit(std::uint32_t hits, double sigma) {
  const auto information = static_cast<float>(hits / (sigma * sigma));
  return {{information, information, information, 0, 0, 0}, {0, 0, 0}, hits};
}

/// A workspace that cuts blocks and cells, with random boxes of free space, whole blocks among
/// them, and random surface.
BeliefGrid random_map(Index3 dims, int surface, double sigma, std::mt19937& random) {
  BeliefGrid grid = test::cut_grid(dims);
  const auto any = [&](int size) {
    return std::uniform_int_distribution<int>(0, size - 1)(random);
  };
  const Index3 low = grid.min_index();
  const VoxelBox workspace = VoxelBox::from_dims(low, dims);
  for (int k = 0; k < 12; ++k) {
    const Index3 from{low.x + any(dims.x), low.y + any(dims.y), low.z + any(dims.z)};
    const VoxelBox box =
        VoxelBox::from_dims(from, {3 + any(24), 3 + any(24), 3 + any(24)}).intersection(workspace);
    grid.update_box(box, std::vector<std::uint8_t>(box.volume(), 1));
  }
  for (int k = 0; k < surface; ++k) {
    const auto hits = static_cast<std::uint32_t>(1 + any(4));
    grid.set({low.x + any(dims.x), low.y + any(dims.y), low.z + any(dims.z)}, 0.85F,
             hit(hits, sigma));
  }
  return grid;
}

TEST(HazardProbe, SaysWhatTheFieldSays) {
  std::mt19937 random(11);
  std::size_t voxels = 0, near = 0, shaped = 0, new_ones = 0;
  for (const Index3 dims : {Index3{41, 29, 35}, Index3{9, 70, 150}, Index3{64, 64, 64}}) {
    for (int shift = 0; shift < 4; ++shift) {
      for (const double sigma : {0.003, 0.02}) {  // below a voxel; combined into cubes
        const BeliefGrid grid = random_map(dims, shift == 1 ? 4 : 60, sigma, random);
        HazardConfig config;
        config.model =
            HazardConfig::Model{30.0, (shift == 0 ? 2.5 : 4.0) * kVoxel * (1 << shift), 0.5};
        const GridSnapshot snapshot = grid.snapshot();
        const HazardField field(snapshot, config);
        const HazardProbe probe(snapshot, config);
        HazardProbe::Reader reader(probe);
        ASSERT_EQ(probe.cell_shift(), field.cell_shift());
        ASSERT_EQ(probe.near_box(), field.near_box());
        const Index3 low = grid.min_index();
        for (int x = low.x - 2; x < low.x + dims.x + 2; ++x) {
          for (int y = low.y - 2; y < low.y + dims.y + 2; y += 2) {
            for (int z = low.z - 2; z < low.z + dims.z + 2; z += 3) {
              const HazardProbe::At at = reader.at({x, y, z});
              ASSERT_EQ(at.distance, field.distance({x, y, z})) << x << " " << y << " " << z;
              ASSERT_EQ(at.start_rate, field.start_rate({x, y, z})) << x << " " << y << " " << z;
              ASSERT_EQ(probe.is_new({x, y, z}), field.is_new({x, y, z}));
              ++voxels;
              near += std::isfinite(at.distance) ? 1 : 0;
              shaped += field.shape({x, y, z}) < 1 ? 1 : 0;
              new_ones += probe.is_new({x, y, z}) ? 1 : 0;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(voxels, 500'000U);
  EXPECT_GT(near, 200'000U);
  EXPECT_GT(shaped, 100'000U);
  EXPECT_GT(new_ones, 100'000U);
  EXPECT_LT(new_ones, voxels - 5'000U);
}

TEST(HazardProbe, ReadersOfManyThreadsAgree) {
  std::mt19937 random(12);
  const Index3 dims{48, 40, 44};
  const BeliefGrid grid = random_map(dims, 60, 0.003, random);
  const HazardProbe probe(grid.snapshot());
  const Index3 low = grid.min_index();
  const auto values = [&] {
    std::vector<double> all;
    HazardProbe::Reader reader(probe);
    for (int x = 0; x < dims.x; x += 3) {
      for (int y = 0; y < dims.y; y += 3) {
        for (int z = 0; z < dims.z; ++z) {
          const HazardProbe::At at = reader.at({low.x + x, low.y + y, low.z + z});
          all.insert(all.end(), {at.distance, at.start_rate});
        }
      }
    }
    return all;
  };
  std::array<std::vector<double>, 4> found;
  std::vector<std::jthread> threads;
  for (std::vector<double>& own : found) threads.emplace_back([&] { own = values(); });
  threads.clear();  // joins them
  const std::vector<double> expected = values();
  EXPECT_EQ(expected.size(), 2U * 16 * 14 * 44);
  for (const std::vector<double>& own : found) EXPECT_EQ(own, expected);
}

TEST(HazardProbe, TakesTheModelAndItsLimitsFromTheMap) {
  std::mt19937 random(3);
  const BeliefGrid grid = random_map({50, 40, 30}, 200, 0.004, random);
  const HazardField field(grid.snapshot());
  const HazardProbe probe(grid.snapshot());
  EXPECT_EQ(probe.model(), field.model());
  EXPECT_TRUE(probe.follows_counters());
  EXPECT_EQ(probe.voxel_size(), kVoxel);
  EXPECT_FALSE(HazardProbe(grid.snapshot(), {.calibrated = false}).follows_counters());

  // Without evidence everything is beyond the cut.
  const BeliefGrid empty = random_map({20, 20, 20}, 0, 0.004, random);
  const HazardProbe nothing(empty.snapshot());
  EXPECT_EQ(nothing.near_box().volume(), 0U);
  const HazardProbe::At at = HazardProbe::Reader(nothing).at({0, 10, -95});
  EXPECT_TRUE(std::isinf(at.distance));
  EXPECT_EQ(at.start_rate, nothing.model().far_rate);
  EXPECT_TRUE(nothing.is_new({0, 10, -95}));
}

}  // namespace
}  // namespace viewgain
