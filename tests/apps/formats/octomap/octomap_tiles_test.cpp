// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A tree's great leaves become tiles of the map.

#include <gtest/gtest.h>

#include <set>

#include "viewgain/formats/octomap_io.hpp"

namespace viewgain {
namespace {

/// An octree of one free leaf, the lowest cube of 65,536 / 2^depth voxels, cut into eight `splits`
/// times along its lowest corner.
std::string free_octree(int depth, int splits) {
  const auto node = [](int children) {
    const float log_odds = -2;
    std::string bytes(reinterpret_cast<const char*>(&log_odds), sizeof log_odds);
    return bytes + static_cast<char>(children);
  };
  std::string nodes;
  for (int i = 0; i < depth; ++i) nodes += node(1);
  for (int i = 0; i < splits; ++i) nodes += node(255);
  for (int i = 0; i < 1 + 7 * splits; ++i) nodes += node(0);
  return "# Octomap OcTree file\nid OcTree\nsize " + std::to_string(nodes.size() / 5) +
         "\nres 0.1\ndata\n" + nodes;
}

TEST(OctomapTiles, HashOfLargeTilesIsThatOfSmallOnes) {
  // 2^39 free voxels. Block by block this would take minutes.
  OctomapConfig config;
  config.workspace = Box{{-3276.8, -3276.8, -3276.8}, {-2457.6, -2457.6, -2457.6}};
  const BeliefGrid whole = grid_from_octomap_bytes(free_octree(3, 0), config);
  ASSERT_EQ(whole.statistics().free, std::uint64_t{1} << 39U);
  const std::string hash = whole.content_hash();
  std::set<std::string> others;
  for (int splits = 1; splits <= 13; ++splits) {
    BeliefGrid cut = grid_from_octomap_bytes(free_octree(3, splits), config);
    EXPECT_EQ(cut.content_hash(), hash) << splits;
    cut.set({-32768, -32768, -32768 + splits}, -1.95F);
    others.insert(cut.content_hash());
    // Away and back leaves a leaf in a node of its own.
    cut.set({-32768, -32768, -32768 + splits}, -2.0F);
    EXPECT_EQ(cut.content_hash(), hash) << splits;
  }
  EXPECT_EQ(others.size(), 13U);
  EXPECT_FALSE(others.contains(hash));

  // Cubes that the workspace cuts: tiles of 128³ against blocks, and against voxels one by one.
  config.workspace = Box{{-3276.5, -3276.8, -3270.8}, {-3256.0, -3260.6, -3261.9}};
  const BeliefGrid tiles = grid_from_octomap_bytes(free_octree(3, 0), config);
  BeliefGrid blocks = tiles.clone(), voxels(GridConfig{0.1, *config.workspace, {}, 0.05});
  const Index3 low = tiles.min_index(), dims = tiles.dims();
  for (int x = low.x; x < low.x + dims.x; ++x) {
    for (int y = low.y; y < low.y + dims.y; ++y) {
      for (int z = low.z; z < low.z + dims.z; ++z) {
        if (x % 8 == 0 && y % 8 == 0 && z % 8 == 0) blocks.set({x, y, z}, -2.0F);
        voxels.set({x, y, z}, -2.0F);
      }
    }
  }
  EXPECT_EQ(blocks.content_hash(), tiles.content_hash());
  EXPECT_EQ(voxels.content_hash(), tiles.content_hash());
  EXPECT_LT(tiles.statistics().bytes, voxels.statistics().bytes);
}

}  // namespace
}  // namespace viewgain
