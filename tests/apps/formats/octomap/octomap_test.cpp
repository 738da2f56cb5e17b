// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Octrees against OctoMap's own library: what it writes is read, what we write it reads.

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/voxels.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/formats/octomap_tree.hpp"

namespace viewgain {
namespace {

using namespace test;

octomap::OcTreeKey key_of(Index3 v) {
  const auto key = [](std::int32_t i) { return static_cast<octomap::key_type>(i + 32768); };
  return {key(v.x), key(v.y), key(v.z)};
}

/// The nearest step of ours, on OctoMap's side of 0.
float rounded(float log_odds) {
  const double steps = std::clamp(std::round(static_cast<double>(log_odds) / 0.05), -40.0, 70.0);
  return static_cast<float>(0.05 * (log_odds >= 0 ? std::max(steps, 1.0) : std::min(steps, 0.0)));
}

/// Random voxels round the origin, a pruned cube of 16³ free ones and one of 16³ occupied ones.
template <typename Tree>
void fill(Tree& tree) {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> place(-40, 25);
  std::uniform_real_distribution<float> value(-2.0F, 3.5F);
  const auto set = [&](Index3 v, float log_odds) { tree.setNodeValue(key_of(v), log_odds, true); };
  for (int i = 0; i < 4000; ++i) set({place(random), place(random), place(random)}, value(random));
  // Near 0, where rounding could change the state.
  for (const float v : {0.0F, 0.01F, -0.01F, -0.024F, 0.024F, 1e-7F, -1e-7F}) {
    set({place(random), place(random), place(random)}, v);
  }
  for_each_voxel(VoxelBox{{0, 0, 0}, {16, 16, 16}}, [&](Index3 voxel) {
    const auto [x, y, z] = voxel;
    set({32 + x, 48 + y, -32 + z}, -2.0F);
    set({-64 + x, y, 16 + z}, 3.5F);
  });
  tree.updateInnerOccupancy();
  tree.prune();
}

/// Voxels of a box round the tree whose state or log-odds is not the tree's.
struct Comparison {
  int voxels = 0, known = 0, differences = 0;
};
template <typename Tree>
Comparison compare(const Tree& tree, const BeliefGrid& grid, bool binary) {
  Comparison result;
  for_each_voxel(VoxelBox{{-70, -50, -50}, {60, 70, 40}}, [&](Index3 voxel) {
    const auto* node = tree.search(key_of(voxel));
    VoxelState state = VoxelState::unknown;
    std::optional<float> log_odds;
    if (node != nullptr) {
      const bool occupied = tree.isNodeOccupied(node);
      state = occupied ? VoxelState::occupied : VoxelState::free;
      log_odds = binary ? (occupied ? 3.5F : -2.0F) : rounded(node->getLogOdds());
      ++result.known;
    }
    ++result.voxels;
    if (grid.state(voxel) != state || grid.log_odds(voxel) != log_odds ||
        grid.belief(voxel).has_value()) {
      ++result.differences;
    }
  });
  EXPECT_EQ(result.voxels, 130 * 120 * 90);
  EXPECT_GT(result.known, 10000);
  return result;
}

// A map that follows a tree box by box is the tree's map.
TEST(Octomap, AGridFollowsATreeThatGrows) {
  constexpr double V = 0.1 / 3;
  octomap::OcTree tree(V);
  const Box workspace{{-1.2, -0.9, -0.7}, {1.3, 1.1, 0.8}};
  BeliefGrid grid({.voxel_size = V, .workspace = workspace, .prior_sigma = V / 2});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-1.4, 1.4);
  std::uint64_t changed = 0;
  int steps = 0;
  for (; steps < 12; ++steps) {
    const std::array<double, 3> eye{at(random) / 3, at(random) / 3, 0.1};
    const auto point = [](const std::array<double, 3>& p) {
      return octomap::point3d(static_cast<float>(p[0]), static_cast<float>(p[1]),
                              static_cast<float>(p[2]));
    };
    octomap::Pointcloud cloud;
    Box region{eye, eye};
    for (int i = 0; i < 200; ++i) {
      const std::array<double, 3> p{at(random), 0.3 + at(random) / 4, at(random) / 2};
      cloud.push_back(point(p));
      for (std::size_t a = 0; a < 3; ++a) {
        region.min[a] = std::min(region.min[a], p[a] - V);
        region.max[a] = std::max(region.max[a], p[a] + V);
      }
    }
    tree.insertPointCloud(cloud, point(eye));
    if (steps % 4 == 3) tree.prune();
    changed += update_from_octree(grid, tree, region);
    EXPECT_EQ(update_from_octree(grid, tree, workspace), 0U) << steps;
    OctomapConfig config;
    config.workspace = workspace;
    const BeliefGrid whole = grid_from_octree(tree, config);
    std::vector<std::uint8_t> states(grid.voxel_count()), expected(whole.voxel_count());
    grid.copy_states(states);
    whole.copy_states(expected);
    ASSERT_EQ(states, expected) << steps;
  }
  EXPECT_EQ(steps, 12);
  EXPECT_GT(changed, 5'000U);
  EXPECT_EQ(update_from_octree(grid, tree, {{5, 5, 5}, {6, 6, 6}}), 0U);
  const octomap::OcTree other(0.05);
  expect_error(ErrorCode::invalid_argument, "the tree and the grid must have the same voxel size",
               [&] { (void)update_from_octree(grid, other, workspace); });
}

TEST(Octomap, TreesInMemoryAreRead) {
  octomap::OcTree tree(0.1 / 3);
  fill(tree);
  const BeliefGrid grid = grid_from_octree(tree);
  EXPECT_EQ(grid.voxel_size(), tree.getResolution());
  EXPECT_EQ(grid.min_index(), (Index3{-64, -40, -40}));
  EXPECT_EQ(grid.dims(), (Index3{112, 104, 72}));
  EXPECT_EQ(grid.prior_sigma(), grid.voxel_size() / 2);
  EXPECT_TRUE(grid.views().empty());
  EXPECT_EQ(compare(tree, grid, false).differences, 0);
}

TEST(Octomap, BothKindsOfFilesAndColoursAreRead) {
  const TemporaryFolder folder;
  octomap::OcTree tree(0.05);
  fill(tree);
  ASSERT_TRUE(tree.write((folder.path() / "a.ot").string()));
  EXPECT_EQ(compare(tree, load_octomap(folder.path() / "a.ot"), false).differences, 0);
  EXPECT_EQ(octomap_resolution_of_bytes(read_all(folder.path() / "a.ot")), 0.05);
  octomap::OcTree likeliest(tree);
  ASSERT_TRUE(likeliest.writeBinary((folder.path() / "a.bt").string()));  // changes the tree
  EXPECT_EQ(compare(tree, load_octomap(folder.path() / "a.bt"), true).differences, 0);

  octomap::ColorOcTree colours(0.05);
  fill(colours);
  colours.setNodeColor(key_of({32, 48, -32}), 10, 20, 30);
  ASSERT_TRUE(colours.write((folder.path() / "c.ot").string()));
  EXPECT_EQ(compare(colours, load_octomap(folder.path() / "c.ot"), false).differences, 0);
  ASSERT_TRUE(colours.writeBinary((folder.path() / "c.bt").string()));
  EXPECT_EQ(compare(tree, load_octomap(folder.path() / "c.bt"), true).differences, 0);
}

TEST(Octomap, TheTreesOwnThresholdHolds) {
  octomap::OcTree tree(0.1);
  tree.setOccupancyThres(0.7);
  tree.setNodeValue(key_of({0, 0, 0}), 0.5F);
  tree.setNodeValue(key_of({1, 0, 0}), 1.5F);
  const BeliefGrid grid = grid_from_octree(tree);
  EXPECT_EQ(grid.state({0, 0, 0}), VoxelState::free);
  EXPECT_EQ(grid.log_odds({0, 0, 0}), 0.0F);
  EXPECT_EQ(grid.state({1, 0, 0}), VoxelState::occupied);
  EXPECT_EQ(grid.log_odds({1, 0, 0}), 1.5F);
}

TEST(Octomap, AWorkspaceCutsAndGrows) {
  octomap::OcTree tree(0.1);
  fill(tree);
  const BeliefGrid all = grid_from_octree(tree);
  // Through the random voxels and both cubes; not on block borders.
  OctomapConfig config;
  config.workspace = Box{{-5.7, -1.3, -2.9}, {3.9, 5.5, 2.5}};
  config.prior_sigma = 0.02;
  const BeliefGrid part = grid_from_octree(tree, config);
  EXPECT_EQ(part.min_index(), (Index3{-57, -13, -29}));
  EXPECT_EQ(part.dims(), (Index3{96, 68, 54}));
  EXPECT_EQ(part.prior_sigma(), 0.02);
  std::vector<std::uint8_t> states(part.voxel_count());
  part.copy_states(states);
  std::size_t at = 0;
  int differences = 0, known = 0;
  for_each_voxel(part, [&](Index3 voxel) {
    known += states[at] != 0;
    differences += all.state(voxel) != static_cast<VoxelState>(states[at++]) ? 1 : 0;
  });
  EXPECT_EQ(differences, 0);
  EXPECT_GT(known, 3000);
  const BeliefGrid::Statistics statistics = part.statistics();
  EXPECT_EQ(statistics.free + statistics.occupied, static_cast<std::uint64_t>(known));

  config.workspace = Box{{-50, -50, -50}, {50, 50, 50}};
  const BeliefGrid more = grid_from_octree(tree, config);
  EXPECT_EQ(more.statistics().free, all.statistics().free);
  EXPECT_EQ(more.statistics().occupied, all.statistics().occupied);
}

/// Everything there is: free tiles of 128³ and 8³ voxels, cut by the workspace's faces, occupied
/// blocks, every code, single voxels.
BeliefGrid make_rich_grid() {
  OctomapConfig config;
  config.workspace = Box{{-30.1, -30.1, -30.1}, {29.9, 30.3, 29.7}};
  octomap::OcTree tree(0.1);
  fill(tree);
  for_each_voxel(VoxelBox{{-256, -256, 128}, {-128, -128, 256}},
                 [&](Index3 voxel) { tree.setNodeValue(key_of(voxel), -2.0F, true); });
  // A pruned free cube that reaches out of the workspace.
  for_each_voxel(VoxelBox{{288, 288, 288}, {320, 320, 320}},
                 [&](Index3 voxel) { tree.setNodeValue(key_of(voxel), -0.4F, true); });
  tree.updateInnerOccupancy();
  tree.prune();
  BeliefGrid grid = grid_from_octree(tree, config);
  for (int i = 0; i <= 110; ++i) {
    grid.set({100 + i % 11, 100 + i / 11, 7}, static_cast<float>(0.05 * (i - 40)));
  }
  return grid;
}

const BeliefGrid& rich_grid() {
  static const BeliefGrid grid = make_rich_grid();
  return grid;
}

TEST(Octomap, RoundTripKeepsStatesAndLogOdds) {
  const TemporaryFolder folder;
  const BeliefGrid& grid = rich_grid();
  EXPECT_GT(grid.statistics().free, 2000000U);
  save_octomap(grid, folder.path() / "map.ot");
  EXPECT_EQ(folder.entries(), 1);
  // The box of the known voxels is less than the workspace; unknown is the same outside.
  const BeliefGrid smaller = load_octomap(folder.path() / "map.ot");
  EXPECT_LT(smaller.voxel_count(), grid.voxel_count());
  EXPECT_EQ(smaller.statistics().free, grid.statistics().free);
  EXPECT_EQ(smaller.statistics().occupied, grid.statistics().occupied);
  // The hash is over every state and log-odds.
  OctomapConfig config;
  config.workspace = grid.workspace();
  config.prior_sigma = grid.prior_sigma();
  EXPECT_EQ(load_octomap(folder.path() / "map.ot", config).content_hash(), grid.content_hash());
  EXPECT_EQ(octomap_bytes(smaller), octomap_bytes(grid));
}

TEST(Octomap, OctomapReadsWhatIsWritten) {
  const TemporaryFolder folder;
  const BeliefGrid& grid = rich_grid();
  save_octomap(grid, folder.path() / "map.ot");
  const std::unique_ptr<octomap::AbstractOcTree> abstract(
      octomap::AbstractOcTree::read((folder.path() / "map.ot").string()));
  ASSERT_NE(abstract, nullptr);
  auto& tree = dynamic_cast<octomap::OcTree&>(*abstract);
  const std::unique_ptr<octomap::OcTree> in_memory = octree_from_grid(grid);
  EXPECT_TRUE(tree == *in_memory);
  EXPECT_EQ(tree.getResolution(), 0.1);

  std::uint64_t free = 0, occupied = 0, wrong = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const Index3 low{key[0] - 32768, key[1] - 32768, key[2] - 32768};
    const int size = 1 << (16 - static_cast<int>(leaf.getDepth()));
    const bool is_occupied = tree.isNodeOccupied(*leaf);
    const VoxelState state = is_occupied ? VoxelState::occupied : VoxelState::free;
    for (int i = 0; i < size * size * size; ++i) {
      const Index3 voxel{low.x + i % size, low.y + i / size % size, low.z + i / size / size};
      wrong += grid.state(voxel) != state;
      ++(is_occupied ? occupied : free);
    }
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(free, grid.statistics().free);
  EXPECT_EQ(occupied, grid.statistics().occupied);
  // As OctoMap itself would prune it, inner nodes as it would set them.
  const std::size_t nodes = tree.size();
  tree.prune();
  EXPECT_EQ(tree.size(), nodes);
  octomap::OcTree updated(tree);
  updated.updateInnerOccupancy();
  EXPECT_TRUE(updated == tree);
}

/// Random blobs over large free and unknown parts, the same in every frame.
BeliefGrid blobs(Index3 low, const Pose& T_world_grid) {
  const double V = 0.1;
  const auto corner = [&](Index3 v) { return std::array<double, 3>{v.x * V, v.y * V, v.z * V}; };
  const Index3 high{low.x + 301, low.y + 170, low.z + 155};
  BeliefGrid grid({V, {corner(low), corner(high)}, T_world_grid, 0.05});
  std::vector<std::uint8_t> states(grid.voxel_count(), 1);
  const auto at = [](int x, int y, int z) {
    return (static_cast<std::size_t>(x) * 170 + static_cast<std::size_t>(y)) * 155 +
           static_cast<std::size_t>(z);
  };
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    const int size = 1 + static_cast<int>(random() % 24), x0 = static_cast<int>(random() % 270),
              y0 = static_cast<int>(random() % 60), z0 = static_cast<int>(random() % 60);
    for_each_voxel(VoxelBox::from_dims({x0, y0, z0}, {size, size, size}), [&](Index3 voxel) {
      const auto [x, y, z] = voxel;
      states[at(x, y, z)] = i % 3 == 0 ? 0 : 2;
    });
  }
  return BeliefGrid::from_states({V, {corner(low), corner(high)}, T_world_grid, 0.05}, states);
}

TEST(Octomap, AFrameOfWholeVoxelsMovesTheTree) {
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  const Index3 low{-37, 11, -150};
  const std::string in_world = octomap_bytes(blobs(low, {}));
  EXPECT_GT(in_world.size(), 20000U);
  for (const Index3 shift :
       {Index3{1, 0, 0}, Index3{-3, 5, 7}, Index3{8, -16, 24}, Index3{128, 256, -128},
        Index3{-2048, 0, 2048}, Index3{-32768 - 37, 32000, -1}, Index3{32000, 1000001, 3}}) {
    // The grid's own lattice lies elsewhere, the voxels in the world do not.
    const Index3 own{low.x - shift.x, low.y - shift.y, low.z - shift.z};
    for (const double off : {0.0, 5e-8}) {
      const Pose T(upright, {0.1 * shift.x + off, 0.1 * shift.y, 0.1 * shift.z - off});
      const BeliefGrid grid = blobs(own, T);
      EXPECT_TRUE(octomap_keeps_frame(grid));
      EXPECT_TRUE(octomap_bytes(grid) == in_world) << shift.x << " " << shift.y << " " << shift.z;
    }
  }
  EXPECT_TRUE(*octree_from_grid(blobs({0, 0, 0}, {upright, {-3.7, 1.1, -15.0}})) ==
              *octree_from_grid(blobs(low, {})));
}

TEST(Octomap, OtherFramesAreLost) {
  const BeliefGrid plain = blobs({-37, 11, -150}, {});
  EXPECT_TRUE(octomap_keeps_frame(plain));
  const std::string bytes = octomap_bytes(plain);
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  const auto turned = [](double angle) {
    return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  };
  int cases = 0;
  for (const Pose& T :
       {Pose(upright, {0.05, 0, 0}), Pose(upright, {0, 1e-6, 0}), Pose(turned(0.3), {0, 0, 0}),
        Pose(turned(1e-6), {0, 0, 0}), Pose(turned(1.5707963267948966), {0.1, 0, 0}),
        Pose(upright, {0, 0, 3276.8}), Pose(upright, {1e12, 0, 0}),
        Pose(upright, {0, -1e300, 0})}) {
    const BeliefGrid grid = blobs({-37, 11, -150}, T);
    EXPECT_FALSE(octomap_keeps_frame(grid)) << cases;
    EXPECT_TRUE(octomap_bytes(grid) == bytes) << cases;
    ++cases;
  }
  EXPECT_EQ(cases, 8);
}

TEST(Octomap, EmptyTrees) {
  octomap::OcTree tree(0.1);
  expect_error(ErrorCode::format, "no known voxel", [&] { (void)grid_from_octree(tree); });
  OctomapConfig config;
  config.workspace = Box{{0, 0, 0}, {1, 1, 1}};
  const BeliefGrid grid = grid_from_octree(tree, config);
  EXPECT_EQ(grid.statistics().unknown, 1000U);
  EXPECT_EQ(octree_from_grid(grid)->size(), 0U);
  EXPECT_EQ(grid_from_octree(*octree_from_grid(grid), config).content_hash(), grid.content_hash());
}

TEST(Octomap, IndicesBeyondATreeAreRefused) {
  BeliefGrid grid({0.1, {{3276.0, 0, 0}, {3277.5, 1, 1}}, {}, 0.05});
  grid.set({32767, 0, 0}, 1.0F);
  EXPECT_EQ(octree_from_grid(grid)->getNumLeafNodes(), 1U);
  grid.set({32768, 0, 0}, 1.0F);
  expect_error(ErrorCode::capacity, "32768", [&] { (void)octomap_bytes(grid); });
}

// Files that are cut, forged or of another kind.
class DamagedOctomap : public testing::Test {
 protected:
  DamagedOctomap() {
    octomap::OcTree tree(0.1);
    for (int i = 0; i < 60; ++i) {
      tree.updateNode(
          octomap::point3d(0.1F * static_cast<float>(i % 7), 0.1F * static_cast<float>(i % 5),
                           0.1F * static_cast<float>(i)),
          i % 2 == 0);
    }
    tree.write((folder_.path() / "good.ot").string());
    tree.writeBinary((folder_.path() / "good.bt").string());
    full_ = read_all(folder_.path() / "good.ot");
    binary_ = read_all(folder_.path() / "good.bt");
  }

  void expect_refused(const std::string& part, const std::string& contents,
                      ErrorCode code = ErrorCode::format) {
    const auto path = folder_.file("bad.ot", contents);
    expect_error(code, part, [&] { (void)load_octomap(path); });
    expect_error(code, "bad.ot", [&] { (void)load_octomap(path); });
    ++cases_;
  }

  TemporaryFolder folder_;
  std::string full_, binary_;
  int cases_ = 0;
};

TEST_F(DamagedOctomap, HeadersAreNamedByLine) {
  const std::string size =
      full_.substr(full_.find("size "), full_.find("\nres") - full_.find("size "));
  for (const char* res : {"0", "-0.1", "nan", "inf", "1e999", "x", ""}) {
    expect_refused("bad.ot:", with(full_, "res 0.1", std::string("res ") + res));
  }
  for (const char* count : {"size", "size -5", "size 99999999999", "size 1e3", "size x"}) {
    expect_refused("bad.ot:", with(full_, size, count));
  }
  for (const char* count : {"size 1", "size 4294967295"}) {
    expect_refused("nodes", with(full_, size, count));
  }
  expect_refused(":4: trees of the type 'OcTreeStamped'",
                 with(full_, "id OcTree", "id OcTreeStamped"));
  expect_refused("no known voxel", with(full_, size, "size 0"));
  expect_refused("\"id\"", with(full_, "id OcTree", "# OcTree"));
  expect_refused("\"size\"", with(full_, size, "# none"));
  expect_refused("\"res\"", with(full_, "res 0.1", "# none"));
  expect_refused("\"data\"", with(full_, "data\n", "date\n"));
  expect_refused(":1: the file is not an OctoMap file", "");
  expect_refused(":1: the file is not an OctoMap file", "ply\nformat ascii 1.0\n");
  expect_refused(":1: the file is not an OctoMap file", std::string(1000, '\0'));
  // A .bt's tree behind a .ot's header and the other way round.
  expect_refused("", with(full_, "# Octomap OcTree file", "# Octomap OcTree binary file"));
  expect_refused("", with(binary_, "# Octomap OcTree binary file", "# Octomap OcTree file"));
  EXPECT_NO_THROW((void)load_octomap(
      folder_.file("good.ot", with(full_, "id OcTree", "# comment\nauthor me\nid OcTree"))));
  expect_error(ErrorCode::io, "none.ot", [&] { (void)load_octomap(folder_.path() / "none.ot"); });
  expect_error(ErrorCode::io, "directory", [&] { (void)load_octomap(folder_.path()); });
}

std::string tree_bytes(const char* kind, int nodes, const std::string& data) {
  return "# Octomap OcTree " + std::string(kind) + "\nid OcTree\nsize " + std::to_string(nodes) +
         "\nres 0.1\ndata\n" + data;
}
std::string node(float log_odds, int children) {
  std::string bytes(4, '\0');
  std::memcpy(bytes.data(), &log_odds, 4);
  bytes.push_back(static_cast<char>(children));
  return bytes;
}

TEST_F(DamagedOctomap, ForgedTrees) {
  std::string deep, deep_binary;
  for (int i = 0; i < 18; ++i) deep += node(0, 1);
  for (int i = 0; i < 18; ++i) deep_binary += std::string("\3\0", 2);
  expect_refused("16 levels", tree_bytes("file", 18, deep));
  expect_refused("16 levels", tree_bytes("binary file", 18, deep_binary));
  expect_refused("not finite", tree_bytes("file", 1, node(std::nanf(""), 0)));
  expect_refused("not finite", tree_bytes("file", 1, node(HUGE_VALF, 0)));
  // One leaf for all of a tree's space, and ones of 8192³ and 1024³ occupied voxels.
  expect_refused("voxels", tree_bytes("file", 1, node(-1, 0)), ErrorCode::capacity);
  std::string solid, small;
  for (int i = 0; i < 3; ++i) solid += node(1, 1);
  for (int i = 0; i < 6; ++i) small += node(1, 1);
  expect_refused("2^27", tree_bytes("file", 4, solid + node(1, 0)), ErrorCode::capacity);
  expect_refused("2^27", tree_bytes("file", 7, small + node(1, 0)), ErrorCode::capacity);
  // Free, the same cube is nothing special.
  const BeliefGrid grid =
      load_octomap(folder_.file("free.ot", tree_bytes("file", 4, solid + node(-1, 0))));
  EXPECT_EQ(grid.statistics().free, std::uint64_t{1} << 39U);
  EXPECT_LT(grid.statistics().bytes, std::uint64_t{1} << 20U);
  EXPECT_EQ(octomap_bytes(grid).size(), tree_bytes("file", 4, solid + node(-1, 0)).size());
  // The corner of a cube of occupied voxels can be had.
  OctomapConfig config;
  config.workspace = Box{{-3276.8, -3276.8, -3276.8}, {-3275, -3275, -3275}};
  EXPECT_EQ(
      load_octomap(folder_.file("solid.ot", tree_bytes("file", 4, solid + node(1, 0))), config)
          .statistics()
          .occupied,
      18U * 18 * 18);
}

}  // namespace
}  // namespace viewgain
