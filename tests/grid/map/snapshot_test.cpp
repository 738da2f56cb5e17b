// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <tuple>

#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain {
namespace {

using namespace test;

/// The states that a snapshot tells; counts voxels that are told twice or lie outside the
/// workspace.
std::vector<std::uint8_t> states_of(const GridSnapshot& s, std::uint64_t& faults) {
  std::vector<std::uint8_t> states(static_cast<std::size_t>(s.dims.x) *
                                       static_cast<std::size_t>(s.dims.y) *
                                       static_cast<std::size_t>(s.dims.z),
                                   1);
  faults = 0;
  const auto tell = [&](int x, int y, int z, std::uint8_t state) {
    x -= s.min_index.x, y -= s.min_index.y, z -= s.min_index.z;
    if (x < 0 || y < 0 || z < 0 || x >= s.dims.x || y >= s.dims.y || z >= s.dims.z) {
      ++faults;
      return;
    }
    auto& at = states[(static_cast<std::size_t>(x) * static_cast<std::size_t>(s.dims.y) +
                       static_cast<std::size_t>(y)) *
                          static_cast<std::size_t>(s.dims.z) +
                      static_cast<std::size_t>(z)];
    if (at != 1) ++faults;
    at = state;
  };
  for (const GridSnapshot::Leaf& leaf : s.leaves) {
    if (leaf.origin.x % 8 != 0 || leaf.origin.y % 8 != 0 || leaf.origin.z % 8 != 0) ++faults;
    for (unsigned n = 0; n < 512; ++n) {
      if (test_bit(leaf.occupied, n) && !test_bit(leaf.non_free, n)) ++faults;
      if (!test_bit(leaf.non_free, n)) continue;
      tell(leaf.origin.x + static_cast<int>(n >> 6U),
           leaf.origin.y + static_cast<int>(n >> 3U & 7U), leaf.origin.z + static_cast<int>(n & 7U),
           test_bit(leaf.occupied, n) ? 2 : 0);
    }
  }
  for (const VoxelBox& tile : s.tiles) {
    for_each_voxel(tile, [&](Index3 v) { tell(v.x, v.y, v.z, 0); });
  }
  return states;
}

std::vector<std::uint8_t> states_of(const BeliefGrid& grid) {
  std::vector<std::uint8_t> states(grid.voxel_count());
  grid.copy_states(states);
  return states;
}

bool is_inside(const GridSnapshot& s, const Index3& v) {
  const Index3 &low = s.min_index, &dims = s.dims;
  return v.x >= low.x && v.y >= low.y && v.z >= low.z && v.x < low.x + dims.x &&
         v.y < low.y + dims.y && v.z < low.z + dims.z;
}

void expect_equal(const GridSnapshot& snapshot, const BeliefGrid& grid) {
  std::uint64_t faults = 0;
  EXPECT_EQ(states_of(snapshot, faults), states_of(grid));
  EXPECT_EQ(faults, 0U);
  std::uint64_t beliefs = 0;
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    for (unsigned n = 0; n < 512; ++n) {
      if (!test_bit(leaf.occupied, n)) continue;
      const Belief* told = leaf.beliefs != nullptr ? leaf.beliefs->find(n) : nullptr;
      const auto held = grid.belief({leaf.origin.x + static_cast<int>(n >> 6U),
                                     leaf.origin.y + static_cast<int>(n >> 3U & 7U),
                                     leaf.origin.z + static_cast<int>(n & 7U)});
      ASSERT_EQ(told != nullptr, held.has_value());
      if (held) {
        ASSERT_EQ(*told, *held);
        ++beliefs;
      }
    }
  }
  EXPECT_LE(beliefs, grid.statistics().occupied);

  // Regions are cubes of 32³ in rising order whose leaves and tiles follow one another.
  const auto cube_of = [](const Index3& v) { return std::tuple(v.x >> 5, v.y >> 5, v.z >> 5); };
  std::uint32_t leaf = 0, tile = snapshot.regions.empty() ? 0 : snapshot.tiles_of(0)[0];
  for (std::size_t r = 0; r < snapshot.regions.size(); ++r) {
    if (r > 0) {
      ASSERT_LT(snapshot.regions[r - 1].number, snapshot.regions[r].number);
    }
    ASSERT_EQ(snapshot.leaves_of(r)[0], leaf);
    ASSERT_EQ(snapshot.tiles_of(r)[0], tile);
    std::set<std::tuple<int, int, int>> cubes;
    for (; leaf < snapshot.leaves_of(r)[1]; ++leaf) {
      cubes.insert(cube_of(snapshot.leaves[leaf].origin));
      ASSERT_EQ(
          snapshot.find_leaf(snapshot.leaves[leaf].origin),
          is_inside(snapshot, snapshot.leaves[leaf].origin) ? &snapshot.leaves[leaf] : nullptr);
    }
    for (; tile < snapshot.tiles_of(r)[1]; ++tile) cubes.insert(cube_of(snapshot.tiles[tile].min));
    ASSERT_LE(cubes.size(), 1U);
  }
  EXPECT_EQ(leaf, snapshot.leaves.size());
  EXPECT_EQ(tile, snapshot.tiles.size());
}

TEST(Snapshot, TellsTheStatesOfTheGrid) {
  std::mt19937 random(23);
  for (const double share : {0.0, 0.002, 0.2, 1.0}) {
    for (const int rest : {0, 1, 2}) {
      for (const double low : {-0.16, 0.013, 12.345}) {
        const GridConfig config{
            0.01, {{low, low, low}, {low + 0.41, low + 0.16, low + 0.27}}, {}, 0.01};
        std::vector<std::uint8_t> states(BeliefGrid(config).voxel_count(),
                                         static_cast<std::uint8_t>(rest));
        std::bernoulli_distribution other(share);
        std::uniform_int_distribution<int> which(0, 2);
        for (std::uint8_t& s : states) {
          if (other(random)) s = static_cast<std::uint8_t>(which(random));
        }
        const BeliefGrid grid = BeliefGrid::from_states(config, states);
        const GridSnapshot snapshot = grid.snapshot();
        std::uint64_t faults = 0;
        EXPECT_EQ(states_of(snapshot, faults), states);
        EXPECT_EQ(faults, 0U);
        EXPECT_EQ(snapshot.dims, grid.dims());
        EXPECT_EQ(snapshot.min_index, grid.min_index());
        // One layer more on all sides is free, too.
        std::size_t wrong = 0, asked = 0;
        const Index3 first = snapshot.min_index, dims = snapshot.dims;
        for (int x = first.x - 1; x <= first.x + dims.x; x += 3) {
          for (int y = first.y - 1; y <= first.y + dims.y; ++y) {
            for (int z = first.z - 1; z <= first.z + dims.z; ++z, ++asked) {
              const bool is_inside = x >= first.x && x < first.x + dims.x && y >= first.y &&
                                     y < first.y + dims.y && z >= first.z && z < first.z + dims.z;
              const bool is_free = !is_inside || grid.state({x, y, z}) == VoxelState::free;
              wrong += snapshot.is_free({x, y, z}) != is_free ? 1U : 0U;
            }
          }
        }
        EXPECT_EQ(wrong, 0U) << "of " << asked;
        EXPECT_EQ(snapshot.voxel_size, 0.01);
      }
    }
  }
}

TEST(Snapshot, AnUnknownWorkspaceIsAFewBoxes) {
  const BeliefGrid grid(GridConfig{0.01, {{-20, -20, -20}, {20, 20, 20}}, {}, 0.01});
  const GridSnapshot snapshot = grid.snapshot();
  EXPECT_TRUE(snapshot.leaves.empty());
  EXPECT_LE(snapshot.tiles.size(), 27U);
  std::uint64_t volume = 0;
  for (const VoxelBox& tile : snapshot.tiles) {
    volume += static_cast<std::uint64_t>(tile.max.x - tile.min.x) *
              static_cast<std::uint64_t>(tile.max.y - tile.min.y) *
              static_cast<std::uint64_t>(tile.max.z - tile.min.z);
  }
  EXPECT_EQ(volume, grid.voxel_count());
  for (const Index3 voxel : {Index3{-2000, -2000, -2000}, Index3{0, 5, -7}, Index3{1999, 0, 1}}) {
    EXPECT_FALSE(snapshot.is_free(voxel));
  }
  EXPECT_TRUE(snapshot.is_free({2000, 0, 0}));
}

// Nodes of 2048³ voxels without a reading are a tile each, the others thousands of tiles of 128³.
TEST(Snapshot, AmongThousandsOfTilesItKnowsWhatIsFree) {
  BeliefGrid grid(GridConfig{0.01, {{-60, -30, -3}, {60, 45, 3}}, {}, 0.01});
  std::mt19937_64 random(5);
  const Index3 first = grid.min_index(), dims = grid.dims();
  const auto any = [&](std::int32_t from, std::int32_t count) {
    return std::uniform_int_distribution<std::int32_t>(from, from + count - 1)(random);
  };
  std::vector<Index3> asked;
  for (int i = 0; i < 40; ++i) {
    asked.push_back({any(-4000, 7000), any(first.y, 3000), any(first.z, dims.z)});
    grid.set(asked.back(), -0.4F);
  }
  const GridSnapshot snapshot = grid.snapshot();
  ASSERT_GT(snapshot.tiles.size(), 5000U);
  for (int i = 0; i < 20'000; ++i) {
    asked.push_back({any(first.x, dims.x), any(first.y, dims.y), any(first.z, dims.z)});
  }
  std::size_t wrong = 0, free = 0;
  for (const Index3& voxel : asked) {
    const bool is_free = grid.state(voxel) == VoxelState::free;
    free += is_free ? 1U : 0U;
    wrong += snapshot.is_free(voxel) != is_free ? 1U : 0U;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GE(free, 40U);
}

TEST(Snapshot, StaysAsItWasAndSharesWhatDidNotChange) {
  const Sensor sensor = small_sensor(64, 48);
  const auto frame = [&](int view) {
    return see_spheres(sensor, ring_view(view), three_spheres_in_a_room());
  };
  BeliefGrid grid(object_grid(64));
  FrameIntegrator integrator(sensor, {}, {2});
  for (int view = 0; view < 3; ++view) integrator.integrate(grid, frame(view), ring_view(view));
  const GridSnapshot before = grid.snapshot();
  expect_equal(before, grid);
  const BeliefGrid then = grid.clone();

  integrator.integrate(grid, frame(4), ring_view(4));
  grid.set({0, 0, 0}, 1.0F, Belief{{1, 1, 1, 0, 0, 0}, {}, 1});
  expect_equal(before, then);
  const GridSnapshot after = grid.snapshot();
  expect_equal(after, grid);

  std::map<std::tuple<int, int, int>, const BeliefBlock*> old_blocks;
  for (const GridSnapshot::Leaf& leaf : before.leaves) {
    old_blocks[{leaf.origin.x, leaf.origin.y, leaf.origin.z}] = leaf.beliefs.get();
  }
  std::size_t shared = 0, changed = 0;
  for (const GridSnapshot::Leaf& leaf : after.leaves) {
    const auto found = old_blocks.find({leaf.origin.x, leaf.origin.y, leaf.origin.z});
    if (leaf.beliefs == nullptr || found == old_blocks.end() || found->second == nullptr) continue;
    ++(leaf.beliefs.get() == found->second ? shared : changed);
  }
  EXPECT_GT(shared, 20U);   // blocks that the last view did not see
  EXPECT_GT(changed, 20U);  // blocks that it did
}

// Leaves taken over from an earlier snapshot are what they would be anew, whatever has happened
// since, in clones too; a snapshot of another grid is of no use and does no harm.
TEST(Snapshot, FromTheOneBeforeIsTheSame) {
  const Sensor sensor = small_sensor(48, 36);
  FrameIntegrator integrator(sensor);
  BeliefGrid grid(object_grid(32));
  const auto frame = [&](int i) {
    return see_spheres(sensor, ring_view(i), three_spheres_in_a_room());
  };
  GridSnapshot before = grid.snapshot();
  std::size_t shared_regions = 0, copied_leaves = 0;
  LeafMask marked_mask;
  marked_mask.fill(0xA5A5A5A5A5A5A5A5U);
  // Is `before` of this grid, or of the one that it is a clone of?
  const auto compare = [&](const BeliefGrid& now, bool is_its_own) {
    const GridSnapshot anew = now.snapshot(), updated = now.snapshot(before);
    expect_equal(updated, now);
    expect_same(updated, anew);
    EXPECT_EQ(updated.shared_until, is_its_own ? before.time : 0U);

    // Marks on the earlier leaves show which were copied: those of the shared regions.
    GridSnapshot marked = before;
    for (GridSnapshot::Leaf& leaf : marked.leaves) leaf.occupied = marked_mask;
    const GridSnapshot traced = now.snapshot(marked);
    ASSERT_EQ(traced.leaves.size(), anew.leaves.size());
    for (std::size_t r = 0; r < traced.regions.size(); ++r) {
      const bool is_shared = traced.is_shared(traced.regions[r]);
      shared_regions += is_shared;
      const auto [first, last] = traced.leaves_of(r);
      for (std::size_t i = first; i < last; ++i) {
        EXPECT_EQ(traced.leaves[i].occupied == marked_mask, is_shared);
        copied_leaves += is_shared;
      }
    }
  };
  for (int i = 0; i < 5; ++i) {
    integrator.integrate(grid, frame(i), ring_view(i));
    compare(grid, true);
    grid.set({i, 0, -i}, i % 2 == 0 ? 1.0F : -1.0F);
    compare(grid, true);
    BeliefGrid clone = grid.clone();
    integrator.integrate(clone, frame(i + 1), ring_view(i + 1));
    compare(clone, true);
    if (i % 2 == 0) before = grid.snapshot();
    clone.set({2, 2, 2}, 1.0F);
    compare(clone, true);
    // Now of a grid that the clone is not a clone of any more.
    const GridSnapshot kept = before;
    before = clone.snapshot();
    compare(grid, false);
    before = kept;
    clone = grid.clone();
    clone.set({2, 2, 2}, 1.0F);
    compare(clone, true);
  }
  EXPECT_GT(shared_regions, 20U);
  EXPECT_GT(copied_leaves, 50U);
}

// A frame that changes no voxel's state has readings all the same.
TEST(Snapshot, FromTheOneBeforeHasTheReadingsOfKnownVoxels) {
  const Sensor sensor = small_sensor(48, 36);
  const DepthFrame frame = see_spheres(sensor, ring_view(0), three_spheres_in_a_room());
  BeliefGrid grid(object_grid(64));
  FrameIntegrator integrator(sensor);
  for (int i = 0; i < 40; ++i) integrator.integrate(grid, frame, ring_view(0));
  const GridSnapshot before = grid.snapshot();
  integrator.integrate(grid, frame, ring_view(0));
  const GridSnapshot anew = grid.snapshot();
  ASSERT_GT(anew.leaves.size(), 10U);
  expect_same(grid.snapshot(before), anew);
}

// Where the workspace ends within a block, crossings beyond its face turn a tile into a leaf.
TEST(Snapshot, FromTheOneBeforeIsTheSameAtARimWithinABlock) {
  const Sensor sensor = small_sensor(48, 36);
  std::size_t leaves = 0;
  for (const double edge : {0.21, 0.133, 0.098}) {
    BeliefGrid grid(GridConfig{0.01, {{-0.1, -0.1, -0.1}, {edge, edge, edge}}, {}, 0.0072});
    FrameIntegrator integrator(sensor);
    GridSnapshot before = grid.snapshot();
    for (int i = 0; i < 8; ++i) {
      DepthFrame frame = see_spheres(sensor, ring_view(i), three_spheres_in_a_room());
      // Some end before the workspace, some at its face, some behind it.
      for (std::size_t p = 0; p < frame.depth.size(); ++p) {
        frame.depth[p] = static_cast<float>(0.25 + 0.05 * i + 0.002 * static_cast<double>(p % 48));
      }
      integrator.integrate(grid, frame, ring_view(i));
      const GridSnapshot anew = grid.snapshot(), updated = grid.snapshot(before);
      expect_same(updated, anew);
      leaves += anew.leaves.size();
      before = updated;
    }
  }
  EXPECT_GT(leaves, 100U);
}

}  // namespace
}  // namespace viewgain
