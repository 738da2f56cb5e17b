// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Map files without a seal, as other programs pack them, and with sizes that somebody has changed.

#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "core/replaced_new.hpp"
#include "core/temporary_folder.hpp"
#include "files/vdb_outline.hpp"
#include "grid/voxels.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace {

std::atomic<std::size_t> largest_allocation{0};

}  // namespace

// Under AddressSanitizer: OpenVDB's reader leaves nodes behind when it throws.
extern "C" const char* __lsan_default_suppressions() { return "leak:openvdb"; }

void on_allocation(std::size_t size) {
  std::size_t before = largest_allocation;
  while (before < size && !largest_allocation.compare_exchange_weak(before, size)) {
  }
}

namespace viewgain {
namespace {

using namespace test;
namespace io = openvdb::io;

constexpr std::uint32_t kPackings[] = {io::COMPRESS_NONE,
                                       io::COMPRESS_ZIP,
                                       io::COMPRESS_BLOSC,
                                       io::COMPRESS_ACTIVE_MASK,
                                       io::COMPRESS_ZIP | io::COMPRESS_ACTIVE_MASK,
                                       io::COMPRESS_BLOSC | io::COMPRESS_ACTIVE_MASK};

/// A free tile, a wall with beliefs, and voxels by themselves.
BeliefGrid small_map() {
  BeliefGrid grid(GridConfig{0.05, {{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}}, {}, 0.1});
  for_each_voxel(VoxelBox{{-8, -8, -8}, {0, 0, 0}}, [&](Index3 v) { grid.set(v, -2.0F); });
  for_each_voxel(VoxelBox{{0, 0, 3}, {8, 8, 4}}, [&](Index3 v) {
    grid.set(v, 1.5F, Belief{{1e4F, 2e4F, 3e4F, 5.0F, 6.0F, 7.0F}, {1.0F, 2.0F, 3.0F}, 4});
  });
  grid.set({-3, 5, 1}, 0.05F);
  grid.append_view(Pose{});
  return grid;
}

std::string packed_map(const TemporaryFolder& folder, std::uint32_t packing, bool is_half) {
  const std::string path = folder.path() / "map.vdb", out = folder.path() / "packed.vdb";
  save_vdb(small_map(), path);
  io::File file(path);
  file.open(false);
  const openvdb::GridPtrVecPtr grids = file.getGrids();
  for (const auto& grid : *grids) grid->setSaveFloatAsHalf(is_half);
  io::File packed(out);
  packed.setCompression(packing);
  packed.write(*grids, *file.getMetadata());
  return read_all(out);
}

TEST(ForgedVdb, MapsPackedInAnyWayAreRead) {
  const TemporaryFolder folder;
  int cases = 0;
  for (const std::uint32_t packing : kPackings) {
    const auto path = folder.file("own.vdb", packed_map(folder, packing, false));
    EXPECT_EQ(load_vdb(path).content_hash(), small_map().content_hash()) << packing;
    // Rates may be stored with half of the bits.
    auto rates = openvdb::FloatGrid::create(0.25F);
    rates->setName("hazard");
    rates->setSaveFloatAsHalf(true);
    for (int i = 0; i < 300; ++i) rates->tree().setValue({i, i % 7, -i % 5}, 0.125F * float(i % 9));
    const std::string file = folder.path() / "rates.vdb";
    io::File out(file);
    out.setCompression(packing);
    out.write(openvdb::GridPtrVec{rates});
    EXPECT_EQ(load_hazard_vdb(file, small_map()).outside, 0.25F) << packing;
    ++cases;
  }
  EXPECT_EQ(cases, 6);
}

// There must be as much room before OpenVDB reads.
TEST(ForgedVdb, TheOutlineKnowsHowLargeTreesAre) {
  const TemporaryFolder folder;
  int cases = 0;
  for (const std::uint32_t packing : kPackings) {
    for (const bool is_half : {false, true}) {
      std::string image = packed_map(folder, packing, is_half);
      const detail::VdbOutline outline = detail::outline_of(image);
      EXPECT_EQ(outline.fault, "");
      io::File file((folder.path() / "packed.vdb").string());
      file.open(false);
      std::uint64_t used = 0;
      const openvdb::GridPtrVecPtr grids = file.getGrids();
      for (const auto& grid : *grids) used += grid->memUsage();
      EXPECT_GE(outline.tree_bytes, used) << packing << is_half;
      EXPECT_LE(outline.tree_bytes, used + used / 10) << packing << is_half;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 12);
}

// OpenVDB takes what memory a size in the file asks for.
TEST(ForgedVdb, NoSizeTakesMemoryThatTheFileDoesNotHave) {
  const TemporaryFolder folder;
  std::mt19937_64 random(5);
  std::size_t read = 0, refused = 0, changed = 0;
  for (const std::uint32_t packing : kPackings) {
    const std::string whole = packed_map(folder, packing, false);
    // Half of what is changed is in what comes before the values.
    std::uniform_int_distribution<std::size_t> anywhere(8, whole.size() - 9);
    std::uniform_int_distribution<std::size_t> near(8,
                                                    std::min<std::size_t>(4000, whole.size() - 9));
    for (int i = 0; i < 250; ++i, ++changed) {
      std::string bytes = whole;
      const std::uint64_t forged[] = {0x7FFF'FFFF'FFFF'FFFF, 0x7FFF'FFFF, 0x1'0000'0000, random(),
                                      random() >> 40U};
      const std::size_t size = i % 2 == 0 ? 4 : 8;
      std::memcpy(&bytes[i % 4 < 2 ? anywhere(random) : near(random)], &forged[i % 5], size);
      const auto path = folder.file("forged.vdb", bytes);
      largest_allocation = 0;
      try {
        (void)load_vdb(path, {.num_threads = 1});
        ++read;
      } catch (const Error& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("forged.vdb"), std::string::npos) << error.what();
      }
      ASSERT_LE(largest_allocation, 2 * whole.size() + (std::size_t{1} << 20U))
          << packing << " " << i;
    }
  }
  EXPECT_EQ(changed, 1500U);
  EXPECT_EQ(read + refused, changed);
  EXPECT_GT(read, 50U);
  EXPECT_GT(refused, 300U);
}

}  // namespace
}  // namespace viewgain
