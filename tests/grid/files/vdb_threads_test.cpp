// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Map files by one thread and by several.

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

using namespace test;

constexpr int kThreads[] = {1, 2, 3, 8};

/// Some 400 leaves and tiles, every tenth voxel occupied, with a belief or without.
BeliefGrid speckled_map() {
  BeliefGrid grid(GridConfig{0.01, {{0, 0, 0}, {0.64, 0.6, 0.5}}, {}, 0.01});
  std::mt19937 random(3);
  std::uniform_int_distribution<int> x(0, 63), y(0, 59), z(0, 49), step(-40, 70);
  for (int i = 0; i < 20'000; ++i) {
    const Index3 voxel{x(random), y(random), z(random)};
    const auto log_odds = static_cast<float>(0.05 * step(random));
    if (i % 2 == 0) {
      grid.set(voxel, log_odds);
    } else {
      const auto hits = static_cast<std::uint32_t>(1 + i % 5);
      grid.set(voxel, log_odds, Belief{{1e4F, 2e4F, 3e4F, 5, 6, 7}, {1, 2, 3}, hits});
    }
  }
  return grid;
}

TEST(VdbThreads, AnyNumberReadsTheSame) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  const BeliefGrid grid = speckled_map();
  save_vdb(grid, path);
  int cases = 0;
  for (const int threads : kThreads) {
    EXPECT_EQ(load_vdb(path, nullptr, {threads}).content_hash(), grid.content_hash()) << threads;
    ++cases;
  }
  EXPECT_EQ(cases, 4);
  expect_error(ErrorCode::invalid_argument, "thread", [&] { (void)load_vdb(path, nullptr, {-1}); });
}

/// The map's grids, read by OpenVDB.
class SpeckledFile : public testing::Test {
 protected:
  SpeckledFile() {
    save_vdb(map_, path_);
    openvdb::io::File in(path_.string());
    in.open(false);
    metadata_ = in.getMetadata();
    grids_ = in.getGrids();
    in.close();
  }
  openvdb::GridBase::Ptr& grid(const std::string& name) {
    for (openvdb::GridBase::Ptr& each : *grids_) {
      if (each->getName() == name) return each;
    }
    throw std::runtime_error("no grid " + name);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "map.vdb";
  const BeliefGrid map_ = speckled_map();
  openvdb::MetaMap::Ptr metadata_;
  openvdb::GridPtrVecPtr grids_;
};

TEST_F(SpeckledFile, OfSeveralErrorsTheFirstIsNamed) {
  auto& log_odds = openvdb::gridPtrCast<openvdb::FloatGrid>(grid("log_odds"))->tree();
  int faults = 0;
  std::string first;
  for (auto leaf = log_odds.beginLeaf(); leaf; ++leaf) {
    if (++faults % 70 != 0 || leaf->isEmpty()) continue;
    const auto voxel = leaf->beginValueOn();
    voxel.setValue(0.012F);  // no step
    const openvdb::Coord at = voxel.getCoord();
    if (first.empty()) {
      first = "[" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ", " +
              std::to_string(at.z()) + "]";
    }
  }
  ASSERT_GT(faults, 300);
  openvdb::io::File(path_.string()).write(*grids_, *metadata_);
  for (const int threads : kThreads) {
    for (int again = 0; again < 5; ++again) {
      expect_error(ErrorCode::format, first, [&] { (void)load_vdb(path_, nullptr, {threads}); });
    }
  }
}

TEST_F(SpeckledFile, StreamsAndGridsThatShareATreeAreRead) {
  // A stream does not say where its grids are.
  const auto write = [&] {
    std::ofstream file(path_, std::ios::binary);
    openvdb::io::Stream(file).write(*grids_, *metadata_);
  };
  write();
  for (const int threads : kThreads) {
    EXPECT_EQ(load_vdb(path_, nullptr, {threads}).content_hash(), map_.content_hash());
  }
  // One tree for two grids: written once.
  grid("information_vector")->setTree(grid("information_offdiagonal")->baseTreePtr());
  write();
  const std::string hash = load_vdb(path_, nullptr, {1}).content_hash();
  EXPECT_NE(hash, map_.content_hash());
  for (const int threads : kThreads) {
    EXPECT_EQ(load_vdb(path_, nullptr, {threads}).content_hash(), hash);
  }
}

}  // namespace
}  // namespace viewgain
