// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Leaves of several scales: what resampling keeps, and that cells are known as a whole.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/map/plain_cells.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

using test::expect_error;
using test::for_each_voxel;
using test::kV;
using test::PlainCells;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Box kAll{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
// Faces on multiples of 8, 4, 2 and 1 voxels.
const GridConfig kConfig{kV, {{-0.08, -0.04, -0.05}, {0.16, 0.12, 0.11}}, {}, 0.01};

/// Readings of somewhere in the voxel, or cell, round a centre.
Belief random_belief(std::mt19937& random, double cell) {
  std::uniform_real_distribution<double> part(-0.45, 0.45), sigma(0.002, 0.01);
  SymmetricMatrix3 information;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Belief belief;
  belief.hits = 1 + random() % 4;
  for (unsigned i = 0; i < belief.hits; ++i) {
    const Eigen::Vector3d d =
        Eigen::Vector3d(part(random), part(random), part(random)).normalized();
    const SymmetricMatrix3 one = measurement_information(d, {sigma(random), sigma(random)});
    information += one;
    vector += one * Eigen::Vector3d(part(random), part(random), part(random)) * cell;
  }
  const double terms[6] = {information.xx, information.yy, information.zz,
                           information.xy, information.xz, information.yz};
  for (std::size_t i = 0; i < 6; ++i) belief.information[i] = static_cast<float>(terms[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    belief.information_vector[i] = static_cast<float>(vector[static_cast<Eigen::Index>(i)]);
  }
  return belief;
}

float step_of(int steps) { return static_cast<float>(0.05 * steps); }

Index3 random_voxel(const BeliefGrid& grid, std::mt19937& random) {
  const auto one = [&](std::int32_t low, std::int32_t n) {
    return low + static_cast<std::int32_t>(random() % static_cast<unsigned>(n));
  };
  const Index3 min = grid.min_index(), d = grid.dims();
  return {one(min.x, d.x), one(min.y, d.y), one(min.z, d.z)};
}

TEST(LeafScales, TenThousandStepsAreThoseOfAPlainReference) {
  std::mt19937 random(44);
  BeliefGrid grid(kConfig);
  PlainCells reference(grid);
  int resampled = 0, set = 0, compared = 0, coarse = 0;
  std::set<int> scales;
  for (int step = 1; step <= 10'000; ++step) {
    if (random() % 3 == 0) {
      const Index3 a = random_voxel(grid, random), b = random_voxel(grid, random);
      const VoxelBox box{{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                         {std::max(a.x, b.x) + 1, std::max(a.y, b.y) + 1, std::max(a.z, b.z) + 1}};
      const int scale = static_cast<int>(random() % 4);
      const auto face = [](int v) { return v * kV; };
      grid.resample({{face(box.min.x), face(box.min.y), face(box.min.z)},
                     {face(box.max.x), face(box.max.y), face(box.max.z)}},
                    scale);
      reference.resample(box, scale);
      ++resampled;
    } else {
      const Index3 v = random_voxel(grid, random);
      const float log_odds = step_of(static_cast<int>(random() % 111) - 40);
      std::optional<Belief> belief;
      if (random() % 2 == 0) belief = random_belief(random, kV * (1 << grid.scale(v)));
      grid.set(v, log_odds, belief);
      reference.set(v, log_odds, belief);
      ++set;
    }
    if (step % 100 != 0) continue;
    std::size_t beliefs = 0;
    for_each_voxel(grid, [&](Index3 v) {
      ASSERT_EQ(grid.scale(v), reference.scale(v));
      const auto expected = reference.log_odds(v);
      ASSERT_EQ(grid.log_odds(v).has_value(), expected.has_value()) << step;
      ASSERT_NEAR(grid.log_odds(v).value_or(9), expected.value_or(9), 1e-6);
      scales.insert(grid.scale(v));
      coarse += grid.scale(v) > 0 ? 1 : 0;
    });
    grid.for_each_belief([&](Index3 v, const Belief& belief) {
      ++beliefs;
      const auto found = reference.cells().find({v.x, v.y, v.z});
      ASSERT_NE(found, reference.cells().end());
      PlainCells::Cell& cell = found->second;
      ASSERT_EQ(belief.hits, cell.hits);
      const Eigen::Matrix3d information = belief.information_matrix().matrix();
      ASSERT_LT((information - cell.information).norm(), 1e-6 * cell.information.norm());
      const auto& e = belief.information_vector;
      const Eigen::Vector3d vector(e[0], e[1], e[2]);
      ASSERT_LT((vector - cell.vector).norm(), 1e-5 * cell.information.norm() * 8 * kV);
      cell.vector = vector;  // or rounding would once send a belief to another child
      ++compared;
    });
    ASSERT_EQ(beliefs, reference.cells().size());
  }
  EXPECT_EQ(resampled + set, 10'000);
  EXPECT_GT(resampled, 3000);
  EXPECT_GT(compared, 2000);
  EXPECT_GT(coarse, 10'000);
  EXPECT_EQ(scales, (std::set{0, 1, 2, 3}));
}

/// Random voxels, half with beliefs, in leaves of all scales.
BeliefGrid mixed_map(unsigned seed) {
  std::mt19937 random(seed);
  BeliefGrid grid(kConfig);
  for (int i = 0; i < 1500; ++i) {
    std::optional<Belief> belief;
    if (i % 2 == 0) belief = random_belief(random, kV);
    grid.set(random_voxel(grid, random), step_of(static_cast<int>(random() % 111) - 40), belief);
  }
  for (int scale = 1; scale <= 3; ++scale) {
    grid.resample({{-0.08 + 0.08 * (scale - 1), -1, -1}, {-0.001 + 0.08 * (scale - 1), 1, 1}},
                  scale);
  }
  return grid;
}

TEST(LeafScales, ACellIsReadAndSetAsAWhole) {
  BeliefGrid grid = mixed_map(1);
  std::mt19937 random(2);
  std::array<int, 4> cells{};
  for_each_voxel(grid, [&](Index3 v) {
    const int low = ~((1 << grid.scale(v)) - 1);
    const Index3 first{v.x & low, v.y & low, v.z & low};
    ASSERT_EQ(grid.log_odds(v), grid.log_odds(first));
    ASSERT_EQ(grid.belief(v), grid.belief(first));
    ++cells[static_cast<std::size_t>(grid.scale(v))];
  });
  for (const int count : cells) EXPECT_GT(count, 300);
  const auto states = [&](VoxelState state) {
    std::uint64_t count = 0;
    for_each_voxel(grid, [&](Index3 v) { count += grid.state(v) == state ? 1U : 0U; });
    return count;
  };
  EXPECT_EQ(grid.statistics().occupied, states(VoxelState::occupied));
  EXPECT_EQ(grid.statistics().unknown, states(VoxelState::unknown));
  for (int i = 0; i < 200; ++i) {
    const Index3 v = random_voxel(grid, random);
    const Belief belief = random_belief(random, kV);
    grid.set(v, 0.5F, belief);
    const int low = ~((1 << grid.scale(v)) - 1);
    const Index3 last{v.x | ~low, v.y | ~low, v.z | ~low};
    ASSERT_EQ(grid.belief(last), belief);
    ASSERT_NEAR(*grid.log_odds(last), 0.5, 1e-6);
  }
  // Each occupied cell is shown once.
  std::uint64_t voxels = 0;
  grid.for_each_occupied([&](const BeliefGrid::VoxelValue& value) {
    voxels += 1ULL << 3 * grid.scale(value.voxel);
    ASSERT_EQ(value.belief, grid.belief(value.voxel));
  });
  EXPECT_EQ(voxels, grid.statistics().occupied);
}

TEST(LeafScales, FilesHashesAndClonesKeepThem) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  std::set<std::string> hashes;
  for (unsigned seed = 0; seed < 10; ++seed) {
    BeliefGrid grid = mixed_map(seed);
    save_vdb(grid, path, {.with_covariance = true});
    const BeliefGrid loaded = load_vdb(path);
    ASSERT_EQ(loaded.content_hash(), grid.content_hash());
    for_each_voxel(grid, [&](Index3 v) {
      ASSERT_EQ(loaded.scale(v), grid.scale(v));
      ASSERT_EQ(loaded.belief(v), grid.belief(v));
    });
    hashes.insert(grid.content_hash());
    BeliefGrid finer = grid.clone();
    ASSERT_GT(finer.resample(kAll, 0), 0U);
    ASSERT_EQ(loaded.content_hash(), grid.content_hash());  // beliefs are shared, not changed
    hashes.insert(finer.content_hash());
  }
  EXPECT_EQ(hashes.size(), 20U);
}

TEST(LeafScales, ADenseArrayAndForgettingLeaveWholeCells) {
  std::mt19937 random(9);
  int boxes = 0, forgotten = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    BeliefGrid grid = mixed_map(seed);
    const Index3 a = random_voxel(grid, random);
    const Index3 end = VoxelBox::from_dims(grid.min_index(), grid.dims()).max;
    const VoxelBox box{
        a, {std::min(a.x + 9, end.x), std::min(a.y + 5, end.y), std::min(a.z + 7, end.z)}};
    if (seed % 2 == 0) {
      std::vector<std::uint8_t> states(box.volume());
      for (std::uint8_t& state : states) state = static_cast<std::uint8_t>(random() % 3);
      grid.update_box(box, states);
      std::size_t i = 0;
      for_each_voxel(box, [&](Index3 voxel) {
        ASSERT_EQ(static_cast<std::uint8_t>(grid.state(voxel)), states[i++]);
      });
      ++boxes;
    } else {
      grid.forget({{box.min.x * kV, box.min.y * kV, box.min.z * kV},
                   {box.max.x * kV, box.max.y * kV, box.max.z * kV}});
      ASSERT_EQ(grid.state(a), VoxelState::unknown);
      ASSERT_FALSE(grid.belief(a));
      ++forgotten;
    }
    for_each_voxel(grid, [&](Index3 v) {
      const int low = ~((1 << grid.scale(v)) - 1);
      ASSERT_EQ(grid.log_odds(v), grid.log_odds({v.x & low, v.y & low, v.z & low}));
    });
  }
  EXPECT_EQ(boxes, 20);
  EXPECT_EQ(forgotten, 20);
}

TEST(LeafScales, EntropyCountsByArea) {
  // A wall of 8² voxels, each with the same reading; a cell of the same readings is worth as much.
  BeliefGrid fine(GridConfig{kV, {{0, 0, 0}, {0.08, 0.08, 0.08}}, {}, 0.01});
  BeliefGrid coarse = fine.clone();
  const Belief belief{{1e5F, 1e5F, 4e5F, 0, 0, 0}, {0, 0, 0}, 1};
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      fine.set({x, y, 3}, 1.0F, belief);
      coarse.set({x, y, 3}, 1.0F, belief);
    }
  }
  const double expected = fine.statistics().entropy_removed;
  EXPECT_GT(expected, 1.0);
  for (int scale = 1; scale <= 3; ++scale) {
    coarse.resample(kAll, scale);
    EXPECT_NEAR(coarse.statistics().entropy_removed, expected, 1e-6 * expected);
  }
}

TEST(LeafScales, ACellAsLargeAsABlockIsNoLeaf) {
  const GridConfig config{kV, {{0, 0, 0}, {64 * kV, 64 * kV, 64 * kV}}, {}, 0.01};
  std::mt19937 random(12);
  BeliefGrid grid(config);
  for (int x = 0; x < 64; x += 8) {
    for (int y = 0; y < 64; y += 8) {
      for (int z = 0; z < 64; z += 16) {
        std::optional<Belief> belief;
        if (x > 0) belief = random_belief(random, 8 * kV);
        grid.set({x, y, z}, 0.85F, belief);
      }
    }
  }
  const std::uint64_t by_voxels = grid.statistics().bytes;
  ASSERT_EQ(grid.resample(kAll, 3), 256U);
  EXPECT_EQ(grid.statistics().occupied, 256U * 512U);
  EXPECT_LT(grid.statistics().bytes, by_voxels / 2);

  // The same states by voxels: what is traced is the same.
  std::vector<std::uint8_t> states(64 * 64 * 64);
  grid.copy_states(states);
  const GridSnapshot coarse = grid.snapshot();
  const GridSnapshot fine = BeliefGrid::from_states(config, states).snapshot();
  ASSERT_EQ(coarse.leaves.size(), 256U);
  ASSERT_EQ(fine.leaves.size(), 256U);
  for (std::size_t i = 0; i < 256; ++i) {
    ASSERT_EQ(coarse.leaves[i].origin, fine.leaves[i].origin);
    ASSERT_EQ(coarse.leaves[i].occupied, fine.leaves[i].occupied);
    ASSERT_EQ(coarse.leaves[i].non_free, fine.leaves[i].non_free);
    ASSERT_EQ(coarse.leaves[i].beliefs != nullptr, coarse.leaves[i].origin.x > 0);
  }
  const test::TemporaryFolder folder;
  save_vdb(grid, folder.path() / "map.vdb");
  const BeliefGrid loaded = load_vdb(folder.path() / "map.vdb");
  EXPECT_EQ(loaded.content_hash(), grid.content_hash());
  EXPECT_LT(loaded.statistics().bytes, by_voxels / 2);
  EXPECT_EQ(loaded.scale({0, 0, 0}), 3);  // without a belief, too

  // Set and cut up again.
  grid.set({1, 2, 3}, -1.0F);
  EXPECT_EQ(grid.state({7, 7, 7}), VoxelState::free);
  EXPECT_EQ(grid.scale({0, 0, 0}), 0);
  EXPECT_EQ(grid.resample(kAll, 0), 255U);
  EXPECT_EQ(grid.statistics().hits, loaded.statistics().hits);
}

TEST(LeafScales, EmptyUniformAndWrong) {
  BeliefGrid grid(kConfig);
  EXPECT_EQ(grid.resample(kAll, 2), 0U);  // nothing is known
  EXPECT_EQ(grid.scale({0, 0, 0}), 0);
  grid.set({0, 0, 0}, 1.0F);
  const std::string hash = grid.content_hash();
  EXPECT_EQ(grid.resample(kAll, 1), 1U);
  EXPECT_EQ(grid.resample(kAll, 1), 0U);
  EXPECT_EQ(grid.state({1, 1, 1}), VoxelState::occupied);
  EXPECT_EQ(grid.state({2, 1, 1}), VoxelState::unknown);
  EXPECT_NE(grid.content_hash(), hash);
  EXPECT_EQ(grid.scale({100, 0, 0}), 0);  // outside
  grid.forget(kAll);
  EXPECT_EQ(grid.content_hash(), BeliefGrid(kConfig).content_hash());
  expect_error(ErrorCode::invalid_argument, "the scale must be in 0..3, not 4",
               [&] { grid.resample(kAll, 4); });
  expect_error(ErrorCode::invalid_argument, "the scale must be in 0..3, not -1",
               [&] { grid.resample(kAll, -1); });
  expect_error(ErrorCode::invalid_argument, "not a number", [&] {
    grid.resample({{std::nan(""), 0, 0}, {1, 1, 1}}, 1);
  });
}

}  // namespace
}  // namespace viewgain
