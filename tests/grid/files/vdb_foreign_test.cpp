// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Map files that another program wrote, well or badly: read, changed and written by OpenVDB itself.

#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/voxels.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

using namespace test;

/// 20 x 12 x 12 voxels: the lower half unknown but for one voxel, free above, a wall with beliefs
/// between.
BeliefGrid small_map() {
  BeliefGrid grid(GridConfig{0.05, {{0, 0, 0}, {1.0, 0.6, 0.6}}, {}, 0.1});
  for_each_voxel(VoxelBox{{0, 0, 6}, {20, 12, 12}}, [&](Index3 v) {
    if (v.z > 6) return grid.set(v, -2.0F);
    grid.set(v, 1.5F, Belief{{1e4F, 2e4F, 3e4F, 5.0F, 6.0F, 7.0F}, {1.0F, 2.0F, 3.0F}, 4});
  });
  grid.set({1, 1, 1}, 0.05F);
  grid.append_view(Pose{});
  return grid;
}

struct Contents {
  openvdb::MetaMap metadata;
  openvdb::GridPtrVec grids;

  static Contents of(const std::filesystem::path& path) {
    openvdb::io::File in(path.string());
    in.open(false);
    Contents contents{*in.getMetadata(), *in.getGrids()};
    in.close();
    return contents;
  }
  template <typename Grid>
  Grid& grid(const std::string& name) {
    for (const auto& g : grids) {
      if (g->getName() == name) return *openvdb::gridPtrCast<Grid>(g);
    }
    throw std::runtime_error("no grid " + name);
  }
  void remove(const std::string& name) {
    std::erase_if(grids, [&](const auto& g) { return g->getName() == name; });
  }
};

class ForeignVdb : public testing::Test {
 protected:
  ForeignVdb() { save_vdb(small_map(), path()); }

  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "map.vdb"; }

  /// Writes the map again after `change`, by OpenVDB.
  std::filesystem::path rewritten(const std::function<void(Contents&)>& change) {
    Contents contents = Contents::of(path());
    change(contents);
    const auto out = folder_.path() / "foreign.vdb";
    openvdb::io::File(out.string()).write(contents.grids, contents.metadata);
    return out;
  }

  void expect_refused(const std::string& part, const std::function<void(Contents&)>& change) {
    const auto file = rewritten(change);
    expect_error(ErrorCode::format, part, [&] { (void)load_vdb(file); });
    expect_error(ErrorCode::format, "foreign.vdb", [&] { (void)load_vdb(file); });
  }

  TemporaryFolder folder_;
};

TEST_F(ForeignVdb, WellFormedFilesAreRead) {
  using openvdb::FloatGrid;
  const std::vector<std::function<void(Contents&)>> changes{
      [](Contents&) {},
      // Other tree topologies of the same values.
      [](Contents& c) { openvdb::tools::prune(c.grid<FloatGrid>("state").tree()); },
      [](Contents& c) { openvdb::tools::prune(c.grid<FloatGrid>("log_odds").tree()); },
      [](Contents& c) { c.grid<FloatGrid>("log_odds").tree().voxelizeActiveTiles(); },
      // More grids and metadata do not matter, nor their order.
      [](Contents& c) {
        std::reverse(c.grids.begin(), c.grids.end());
        auto more = FloatGrid::create();
        more->setName("density");
        c.grids.push_back(more);
        c.metadata.insertMeta("comment", openvdb::StringMetadata("more"));
      }};
  for (const auto& change : changes) {
    EXPECT_EQ(load_vdb(rewritten(change)).content_hash(), small_map().content_hash());
  }
}

// In meters from the voxel's centre, so that single precision serves maps far from the origin.
TEST_F(ForeignVdb, MeansOfReadingsAreExactAnywhere) {
  const auto path = folder_.path() / "map.vdb";
  BeliefGrid grid(GridConfig{0.02, {{5e5, 4e6, 0}, {5e5 + 1, 4e6 + 1, 1}}, {}, 0.1});
  const Index3 voxel{grid.min_index().x + 1, grid.min_index().y + 2, grid.min_index().z + 3};
  const Belief belief{{1e4F, 2e4F, 3e4F, 5.0F, 6.0F, 7.0F}, {1.0F, 2.0F, 3.0F}, 4};
  grid.set(voxel, 1.0F, belief);
  save_vdb(grid, path, {.with_covariance = true});
  Contents contents = Contents::of(path);
  const auto& means = contents.grid<openvdb::Vec3SGrid>("mean_offset");
  ASSERT_EQ(means.activeVoxelCount(), 1U);
  const openvdb::Vec3f mean = means.tree().getValue({voxel.x, voxel.y, voxel.z});
  const Eigen::Vector3d expected =
      belief.information_matrix().matrix().inverse() * Eigen::Vector3d(1, 2, 3);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(double{mean[axis]}, expected[axis], 1e-7 * expected.norm());
  }
}

TEST_F(ForeignVdb, HitsBeyondWhatAFloatHoldsAreKept) {
  const auto names = [&] {
    std::string all;
    (void)rewritten([&](Contents& c) {
      for (const auto& grid : c.grids) all += grid->getName() + " ";
    });
    return all;
  };
  EXPECT_EQ(names().find("hits_rest"), std::string::npos);
  BeliefGrid grid = small_map();
  Belief belief = *grid.belief({3, 4, 6});
  std::int32_t x = 0;
  const std::vector<std::uint32_t> counts{16777216U,  16777217U,   16777219U,  33554435U,
                                          999999999U, 2147483583U, 2147483647U};
  for (const std::uint32_t hits : counts) {
    belief.hits = hits;
    grid.set({x++, 4, 6}, 1.5F, belief);
  }
  save_vdb(grid, path());
  EXPECT_NE(names().find("hits_rest"), std::string::npos);
  const BeliefGrid loaded = load_vdb(path());
  EXPECT_EQ(loaded.content_hash(), grid.content_hash());
  x = 0;
  for (const std::uint32_t hits : counts) EXPECT_EQ(loaded.belief({x++, 4, 6})->hits, hits);
  EXPECT_EQ(x, 7);
  expect_refused("hits", [](Contents& c) {
    c.grid<openvdb::FloatGrid>("hits_rest").tree().setValueOn({3, 4, 6}, 0.5F);
  });
}

TEST_F(ForeignVdb, ScalesMustBeThoseOfStatesAndBeliefs) {
  using openvdb::FloatGrid;
  BeliefGrid grid = small_map();
  grid.resample({{0, 0, 0}, {0.8, 0.4, 0.4}}, 2);  // of leaves that end at voxels 8 and 16
  save_vdb(grid, path());
  ASSERT_EQ(grid.scale({3, 3, 3}), 2);
  const std::string hash = grid.content_hash();
  EXPECT_EQ(load_vdb(rewritten([](Contents&) {})).content_hash(), hash);
  EXPECT_EQ(load_vdb(rewritten([](Contents& c) {
              c.grid<FloatGrid>("scale").tree().voxelizeActiveTiles();
              c.grid<FloatGrid>("scale").tree().fill({{8, 8, 8}, {19, 11, 11}}, 0, false);
            })).content_hash(),
            hash);
  const auto refused = [&](const std::function<void(openvdb::FloatTree&)>& change) {
    expect_refused("grid 'scale': the leaf of voxel",
                   [&](Contents& c) { change(c.grid<FloatGrid>("scale").tree()); });
  };
  for (const float value : {0.0F, -1.0F, 1.5F, 3.0F, 4.0F, std::nanf("")}) {
    refused([&](auto& tree) { tree.fill({{0, 0, 0}, {7, 7, 7}}, value); });
  }
  refused([](auto& tree) { tree.setValueOff({3, 3, 3}); });
  refused([](auto& tree) { tree.setValueOn({3, 3, 3}, 1.0F); });
  refused([](auto& tree) { tree.fill({{16, 0, 0}, {19, 7, 7}}, 3.0F); });  // does not fit
  refused([](auto& tree) { tree.fill({{16, 0, 0}, {19, 7, 7}}, 1.0F); });  // nor do its beliefs
  expect_refused("no grid 'scale'", [](Contents& c) { c.remove("scale"); });
  expect_refused("grid 'scale': the leaf of voxel [0, 0, 0]", [](Contents& c) {
    c.grid<FloatGrid>("log_odds").tree().setValueOn({1, 1, 1}, 0.5F);
    c.grid<FloatGrid>("state").tree().setValueOn({1, 1, 1}, 2.0F);
  });
}

TEST_F(ForeignVdb, MissingPartsAndWrongTypesAreNamed) {
  for (const char* name : {"viewgain_version", "voxel_size", "prior_sigma", "workspace_min",
                           "workspace_max", "T_world_grid", "views"}) {
    expect_refused(name, [&](Contents& c) { c.metadata.removeMeta(name); });
    expect_refused(name, [&](Contents& c) {
      c.metadata.removeMeta(name);
      c.metadata.insertMeta(name, openvdb::BoolMetadata(true));
    });
  }
  for (const char* name : {"state", "log_odds", "information_diagonal", "information_offdiagonal",
                           "information_vector", "hits"}) {
    expect_refused(name, [&](Contents& c) { c.remove(name); });
    expect_refused(name, [&](Contents& c) {
      c.remove(name);
      auto other = openvdb::DoubleGrid::create();
      other->setName(name);
      c.grids.push_back(other);
    });
  }
}

TEST_F(ForeignVdb, ValuesOutOfBoundsAreNamed) {
  const auto metadata = [&](const std::string& part, const char* name,
                            const openvdb::Metadata& value) {
    expect_refused(part, [&](Contents& c) {
      c.metadata.removeMeta(name);
      c.metadata.insertMeta(name, value);
    });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::int32_t version : {0, 1, 4}) {
    metadata("the map's viewgain_version " + std::to_string(version) +
                 " is not supported; this program reads versions 2 and 3",
             "viewgain_version", openvdb::Int32Metadata(version));
  }
  metadata("voxel size", "voxel_size", openvdb::DoubleMetadata(-1));
  metadata("transform", "voxel_size", openvdb::DoubleMetadata(0.06));
  metadata("prior sigma", "prior_sigma", openvdb::DoubleMetadata(0));
  metadata("workspace_max", "workspace_max", openvdb::Vec3IMetadata({20, 0, 12}));
  metadata("workspace", "workspace_max", openvdb::Vec3IMetadata({2000000000, 12, 12}));
  metadata("outside", "workspace_max", openvdb::Vec3IMetadata({19, 12, 12}));
  metadata("outside", "workspace_min", openvdb::Vec3IMetadata({0, 0, 2}));
  metadata("T_world_grid", "T_world_grid", openvdb::StringMetadata("1 0 0 0 0 1 0 0 0 0 1"));
  metadata("T_world_grid", "T_world_grid", openvdb::StringMetadata("2 0 0 0 0 1 0 0 0 0 1 0\n"));
  metadata("views", "views", openvdb::StringMetadata("1 0 0 nan 0 1 0 0 0 0 1 0\n"));
  for (const char* note : {"frame-000000.depth.png\n", "0123456789abcdef\n", "0123456789abcdef \n",
                           "0123456789ABCDEF a.png\n", "0123456789abcdef0 a.png\n", "\n"}) {
    metadata("the identity of a frame must be", "note_frames", openvdb::StringMetadata(note));
  }

  const openvdb::Coord wall(3, 4, 6), free(3, 4, 9), unknown(3, 4, 3);
  const auto log_odds = [&](const std::string& part, const openvdb::Coord& at, float value) {
    expect_refused(part, [&](Contents& c) {
      c.grid<openvdb::FloatGrid>("log_odds").tree().setValueOn(at, value);
    });
  };
  log_odds("log_odds", wall, 3.6F);
  log_odds("log_odds", wall, static_cast<float>(nan));
  log_odds("log_odds", free, -2.1F);
  log_odds("multiple of 0.05", wall, 1.52F);
  log_odds("contradicts", wall, -1.0F);
  log_odds("contradicts", free, 1.0F);
  log_odds("different voxels", unknown, 1.0F);
  for (const float state : {0.0F, 1.0F, 3.0F, -1.0F, 1.5F, static_cast<float>(nan)}) {
    expect_refused("state", [&](Contents& c) {
      c.grid<openvdb::FloatGrid>("state").tree().setValueOn(wall, state);
    });
  }
  expect_refused("different voxels", [&](Contents& c) {
    c.grid<openvdb::FloatGrid>("state").tree().setValueOff(wall);
  });
  expect_refused("different voxels", [&](Contents& c) {
    // As many voxels, but others.
    c.grid<openvdb::FloatGrid>("state").tree().setValueOff(wall);
    c.grid<openvdb::FloatGrid>("state").tree().setValueOn(unknown, 1);
  });

  const auto vector = [&](const char* name, const openvdb::Vec3f& value) {
    expect_refused("belief", [&](Contents& c) {
      c.grid<openvdb::Vec3SGrid>(name).tree().setValueOn(wall, value);
    });
  };
  const auto bad = static_cast<float>(nan);
  vector("information_diagonal", {1, -1, 1});
  vector("information_offdiagonal", {bad, 0, 0});
  vector("information_offdiagonal", {1e8F, 0, 0});
  vector("information_vector", {0, std::numeric_limits<float>::infinity(), 0});
  for (const float hits : {-4.0F, 0.5F, 2147483648.0F, bad}) {
    expect_refused("hits", [&](Contents& c) {
      c.grid<openvdb::FloatGrid>("hits").tree().setValueOn(wall, hits);
    });
  }
  expect_refused("beliefs",
                 [&](Contents& c) { c.grid<openvdb::FloatGrid>("hits").tree().setValueOff(wall); });
  expect_refused("beliefs", [&](Contents& c) {
    c.grid<openvdb::FloatGrid>("hits").tree().setValueOff(wall);
    c.grid<openvdb::FloatGrid>("hits").tree().setValueOn(unknown, 1);
  });
  expect_refused("unknown", [&](Contents& c) {
    for (const char* name :
         {"information_diagonal", "information_offdiagonal", "information_vector"}) {
      c.grid<openvdb::Vec3SGrid>(name).tree().setValueOn(unknown, openvdb::Vec3f(1));
    }
    c.grid<openvdb::FloatGrid>("hits").tree().setValueOn(unknown, 1);
  });
  expect_refused("tiles", [&](Contents& c) {
    for (const char* name :
         {"information_diagonal", "information_offdiagonal", "information_vector"}) {
      c.grid<openvdb::Vec3SGrid>(name).tree().clear();
      c.grid<openvdb::Vec3SGrid>(name).tree().addTile(1, {8, 0, 0}, openvdb::Vec3f(1), true);
    }
    c.grid<openvdb::FloatGrid>("hits").tree().clear();
    c.grid<openvdb::FloatGrid>("hits").tree().addTile(1, {8, 0, 0}, 1, true);
  });
}

/// A workspace of 4096³ voxels that are one tile of 4096³, of the given log-odds.
class ForeignTiles : public testing::Test {
 protected:
  static constexpr int kSize = 4096;

  ForeignTiles() {
    openvdb::initialize();
    log_odds_->setName("log_odds");
    states_->setName("state");
  }

  void fill(float log_odds) { log_odds_->tree().addTile(3, {0, 0, 0}, log_odds, true); }
  void fill_states(openvdb::Index level, int step, float state) {
    const auto add = [&](Index3 v) {
      states_->tree().addTile(level, {v.x, v.y, v.z}, state, true);
    };
    for_each_voxel(VoxelBox{{0, 0, 0}, {kSize, kSize, kSize}}, add, step);
  }

  [[nodiscard]] std::filesystem::path written() const {
    openvdb::MetaMap metadata;
    metadata.insertMeta("viewgain_version", openvdb::Int32Metadata(2));
    metadata.insertMeta("voxel_size", openvdb::DoubleMetadata(0.1));
    metadata.insertMeta("prior_sigma", openvdb::DoubleMetadata(0.05));
    metadata.insertMeta("workspace_min", openvdb::Vec3IMetadata({0, 0, 0}));
    metadata.insertMeta("workspace_max", openvdb::Vec3IMetadata({kSize, kSize, kSize}));
    metadata.insertMeta("T_world_grid", openvdb::StringMetadata("1 0 0 0 0 1 0 0 0 0 1 0\n"));
    metadata.insertMeta("views", openvdb::StringMetadata(""));
    openvdb::GridPtrVec grids{states_, log_odds_, openvdb::FloatGrid::create()};
    grids.back()->setName("hits");
    for (const char* name :
         {"information_diagonal", "information_offdiagonal", "information_vector"}) {
      grids.push_back(openvdb::Vec3SGrid::create());
      grids.back()->setName(name);
    }
    const auto transform = openvdb::math::Transform::createLinearTransform(0.1);
    transform->postTranslate(openvdb::Vec3d(0.05));
    for (const auto& grid : grids) grid->setTransform(transform);
    const auto path = folder_.path() / "tiles.vdb";
    openvdb::io::File(path.string()).write(grids, metadata);
    return path;
  }

  TemporaryFolder folder_;
  openvdb::FloatGrid::Ptr log_odds_ = openvdb::FloatGrid::create();
  openvdb::FloatGrid::Ptr states_ = openvdb::FloatGrid::create();
};

TEST_F(ForeignTiles, OccupiedOnesAreLimited) {
  fill(3.5F);
  fill_states(3, kSize, 2);
  const auto file = written();
  EXPECT_LT(std::filesystem::file_size(file), 10000U);
  expect_error(ErrorCode::capacity, "tiles.vdb", [&] { (void)load_vdb(file); });
  expect_error(ErrorCode::capacity, "2^27", [&] { (void)load_vdb(file); });
}

// Voxel by voxel this would take an hour.
TEST_F(ForeignTiles, StatesMayBeFinerTiles) {
  fill(-2.0F);
  fill_states(3, kSize, 1);
  const std::string hash = load_vdb(written()).content_hash();
  fill_states(2, 128, 1);
  const openvdb::Coord somewhere(1000, 2000, 3000);
  states_->tree().addTile(1, somewhere, 1, true);
  states_->tree().touchLeaf({3000, 20, 30});
  ASSERT_EQ(states_->activeVoxelCount(), log_odds_->activeVoxelCount());
  ASSERT_EQ(states_->tree().leafCount(), 1U);
  const BeliefGrid grid = load_vdb(written());
  EXPECT_EQ(grid.statistics().free, std::uint64_t{1} << 36U);
  EXPECT_EQ(grid.content_hash(), hash);

  states_->tree().setValueOn({3000, 20, 30}, 2);
  expect_error(ErrorCode::format, "[3000, 20, 30] contradicts", [&] { (void)load_vdb(written()); });
  states_->tree().setValueOn({3000, 20, 30}, 1);
  states_->tree().addTile(1, somewhere, 2, true);
  expect_error(ErrorCode::format, "[1000, 2000, 3000] contradicts",
               [&] { (void)load_vdb(written()); });
  states_->tree().addTile(1, somewhere, 1, false);
  expect_error(ErrorCode::format, "different voxels", [&] { (void)load_vdb(written()); });
}

// As many voxels, but others: a hole in the states, and a state where nothing is known.
TEST_F(ForeignTiles, HolesInFinerStatesAreFound) {
  log_odds_->tree().addTile(2, {128, 0, 0}, -2.0F, true);
  states_->tree().addTile(2, {128, 0, 0}, 1, true);
  states_->tree().addTile(1, {160, 32, 8}, 1, false);
  states_->tree().addTile(1, {1024, 0, 0}, 1, true);
  expect_error(ErrorCode::format, "different voxels", [&] { (void)load_vdb(written()); });
  // A block's tile over single voxels.
  log_odds_->tree().clear();
  states_->tree().clear();
  log_odds_->tree().addTile(1, {8, 8, 8}, -2.0F, true);
  states_->tree().addTile(1, {8, 8, 8}, 1, true);
  states_->tree().touchLeaf({8, 8, 8});
  EXPECT_EQ(load_vdb(written()).statistics().free, 512U);
  states_->tree().setValueOff({9, 10, 11});
  states_->tree().setValueOn({100, 0, 0}, 1);
  expect_error(ErrorCode::format, "different voxels", [&] { (void)load_vdb(written()); });
}

/// Rates on a lattice that is turned, shifted and coarser than the map's.
openvdb::FloatGrid::Ptr turned_rates() {
  auto rates = openvdb::FloatGrid::create(0.25F);
  openvdb::Mat4d to_world = openvdb::Mat4d::identity();
  to_world.preScale(openvdb::Vec3d(0.07));
  to_world.postRotate(openvdb::math::Z_AXIS, 0.4);
  to_world.postTranslate(openvdb::Vec3d(0.1, -0.02, 0.03));
  rates->setTransform(openvdb::math::Transform::createLinearTransform(to_world));
  for_each_voxel(VoxelBox{{0, 0, -2}, {6, 5, 4}}, [&](Index3 v) {
    const auto [i, j, k] = v;
    if ((i + j + k) % 3 != 0)
      rates->tree().setValueOn({i, j, k}, static_cast<float>(1 + i + 0.1 * j + k * k));
  });
  // An inactive voxel says nothing, whatever value it has.
  rates->tree().setValueOff({1, 1, 0}, -7.0F);
  return rates;
}

float rate_at(const HazardConfig::Volume& volume, Index3 v) {
  if (!volume.box.contains(v)) return volume.outside;
  const VoxelBox& b = volume.box;
  const auto at = [](std::int32_t value, std::int32_t from) {
    return static_cast<std::size_t>(value - from);
  };
  return volume
      .rates[(at(v.x, b.min.x) * at(b.max.y, b.min.y) + at(v.y, b.min.y)) * at(b.max.z, b.min.z) +
             at(v.z, b.min.z)];
}

TEST_F(ForeignVdb, RatesOfAnyLatticeAreRead) {
  const Pose T_world_grid(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix(),
                          Eigen::Vector3d(0.05, -0.1, 0.02));
  const BeliefGrid turned(
      GridConfig{0.02, {{-0.1, -0.2, -0.1}, {0.5, 0.6, 0.4}}, T_world_grid, 0.1});
  int cases = 0, active = 0;
  for (const BeliefGrid& map : {small_map(), turned.clone()}) {
    const auto rates = turned_rates();
    const auto file = rewritten([&](Contents& c) { c.grids = {rates}; });
    const HazardConfig::Volume volume = load_hazard_vdb(file, map);
    EXPECT_EQ(volume.outside, 0.25F);
    for_each_voxel(map, [&](Index3 v) {
      const Eigen::Vector3d p = map.center(v);
      const auto at = openvdb::Coord::round(rates->worldToIndex({p.x(), p.y(), p.z()}));
      const bool is_active = rates->tree().isValueOn(at);
      ASSERT_EQ(rate_at(volume, v), is_active ? rates->tree().getValue(at) : 0.25F);
      active += rates->tree().isValueOn(at) ? 1 : 0;
      ++cases;
    });
    // As our own file, exactly.
    save_hazard_vdb(volume, map, folder_.path() / "own.vdb");
    const HazardConfig::Volume again = load_hazard_vdb(folder_.path() / "own.vdb", map);
    EXPECT_EQ(again.box, volume.box);
    EXPECT_EQ(again.rates, volume.rates);
    EXPECT_EQ(again.outside, volume.outside);
  }
  EXPECT_EQ(cases, 20 * 12 * 12 + 30 * 40 * 25);
  EXPECT_GT(active, 500);
}

TEST_F(ForeignVdb, OtherGridsBesideTheRatesDoNotMatter) {
  const auto named = [](const char* name, float value) {
    auto grid = openvdb::FloatGrid::create(value);
    grid->setName(name);
    return grid;
  };
  const BeliefGrid map = small_map();
  const auto load = [&](const openvdb::GridPtrVec& grids) {
    return load_hazard_vdb(rewritten([&](Contents& c) { c.grids = grids; }), map);
  };
  EXPECT_EQ(load({named("density", 1), named("hazard", 2)}).outside, 2.0F);
  const HazardConfig::Volume alone = load({named("density", 3)});
  EXPECT_EQ(alone.outside, 3.0F);
  EXPECT_EQ(alone.box.volume(), 0U);
  EXPECT_EQ(load({openvdb::Int32Grid::create(7), named("", 4)}).outside, 4.0F);

  const auto refused = [&](const char* part, const openvdb::GridPtrVec& grids) {
    expect_error(ErrorCode::format, part, [&] { (void)load(grids); });
    expect_error(ErrorCode::format, "foreign.vdb", [&] { (void)load(grids); });
  };
  refused("2 grids of floats", {named("a", 1), named("b", 1)});
  refused("0 grids of floats", {openvdb::Int32Grid::create(7)});
  refused("-1", {named("hazard", -1)});
  refused("nan", {named("hazard", std::numeric_limits<float>::quiet_NaN())});
  auto infinite = named("hazard", 1);
  infinite->tree().setValueOn({0, 0, 0}, std::numeric_limits<float>::infinity());
  refused("inf", {infinite});
  auto frustum = named("hazard", 1);
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 1.0, 0.1));
  refused("not linear", {frustum});
  expect_error(ErrorCode::format, "3 grids of floats", [&] { (void)load_hazard_vdb(path(), map); });
  expect_error(ErrorCode::io, "none.vdb",
               [&] { (void)load_hazard_vdb(folder_.path() / "none.vdb", map); });
}

// Without a seal a cut file is only as safe as OpenVDB's reader and our stream make it.
TEST_F(ForeignVdb, TruncatedWithoutASeal) {
  const std::string whole = read_all(rewritten([](Contents&) {}));
  int cases = 0;
  for (std::size_t length = 0; length + 1 < whole.size(); length += whole.size() / 100 + 1) {
    const auto cut = folder_.file("cut.vdb", std::string_view(whole).substr(0, length));
    expect_error(ErrorCode::format, "cut.vdb", [&] { (void)load_vdb(cut); });
    ++cases;
  }
  EXPECT_GT(cases, 90);
}

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
    EXPECT_EQ(load_vdb(path, {threads}).content_hash(), grid.content_hash()) << threads;
    ++cases;
  }
  EXPECT_EQ(cases, 4);
  expect_error(ErrorCode::invalid_argument, "thread", [&] { (void)load_vdb(path, {-1}); });
}

/// The map's grids, read by OpenVDB.
class SpeckledFile : public testing::Test {
 protected:
  SpeckledFile() {
    save_vdb(map_, path_);
    contents_ = Contents::of(path_);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "map.vdb";
  const BeliefGrid map_ = speckled_map();
  Contents contents_;
};

TEST_F(SpeckledFile, OfSeveralErrorsTheFirstIsNamed) {
  auto& log_odds = contents_.grid<openvdb::FloatGrid>("log_odds").tree();
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
  openvdb::io::File(path_.string()).write(contents_.grids, contents_.metadata);
  for (const int threads : kThreads) {
    for (int again = 0; again < 5; ++again) {
      expect_error(ErrorCode::format, first, [&] { (void)load_vdb(path_, {threads}); });
    }
  }
}

TEST_F(SpeckledFile, StreamsAndGridsThatShareATreeAreRead) {
  // A stream does not say where its grids are.
  const auto write = [&] {
    std::ofstream file(path_, std::ios::binary);
    openvdb::io::Stream(file).write(contents_.grids, contents_.metadata);
  };
  write();
  for (const int threads : kThreads) {
    EXPECT_EQ(load_vdb(path_, {threads}).content_hash(), map_.content_hash());
  }
  // One tree for two grids: written once.
  using openvdb::Vec3SGrid;
  contents_.grid<Vec3SGrid>("information_vector")
      .setTree(contents_.grid<Vec3SGrid>("information_offdiagonal").baseTreePtr());
  write();
  const std::string hash = load_vdb(path_, {1}).content_hash();
  EXPECT_NE(hash, map_.content_hash());
  for (const int threads : kThreads) {
    EXPECT_EQ(load_vdb(path_, {threads}).content_hash(), hash);
  }
}

}  // namespace
}  // namespace viewgain
