// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include "viewgain/grid/vdb_io.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "core/comma_locale.hpp"
#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain {
namespace {

using namespace test;

BeliefGrid seen_object(int voxels) {
  GridConfig config = object_grid(voxels);
  config.workspace.max[0] = 0.17;  // no multiple of 8
  config.T_world_grid =
      Pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix(),
           Eigen::Vector3d(0.01, 0.02, 0.03));
  config.prior_sigma = 0.1 / 3.0;
  BeliefGrid grid(config);
  const Sensor sensor = small_sensor(64, 48);
  FrameIntegrator integrator(sensor);
  for (int view = 0; view < 3; ++view) {
    integrator.integrate(grid, see_spheres(sensor, ring_view(view), three_spheres_in_a_room()),
                         ring_view(view));
  }
  return grid;
}

void expect_same(const BeliefGrid& a, const BeliefGrid& b) {
  EXPECT_EQ(a.content_hash(), b.content_hash());
  EXPECT_EQ(a.voxel_size(), b.voxel_size());
  EXPECT_EQ(a.prior_sigma(), b.prior_sigma());
  EXPECT_EQ(a.T_world_grid(), b.T_world_grid());
  EXPECT_EQ(a.min_index(), b.min_index());
  EXPECT_EQ(a.dims(), b.dims());
  EXPECT_EQ(a.views(), b.views());
  if (a.voxel_count() > 10000000) return;
  std::vector<std::uint8_t> states_a(a.voxel_count()), states_b(b.voxel_count());
  a.copy_states(states_a);
  b.copy_states(states_b);
  EXPECT_EQ(states_a, states_b);
}

TEST(VdbIo, NotesComeWithTheMap) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  BeliefGrid grid = seen_object(64);
  const std::string hash = grid.content_hash();
  const MapNotes notes{.sensor = "name = \"mine\"\n",
                       .frames = {"0123456789abcdef a b.png", "fedcba9876543210 c.png"},
                       .others = {{"planner", "version 1\nseen 0.25\n"},
                                  {"", "no name"},
                                  {"empty", ""},
                                  {"bytes", "\x01\xff"}}};
  grid.set_notes(notes);
  EXPECT_EQ(grid.clone().notes(), notes);
  save_vdb(grid, path);
  for (int again = 0; again < 2; ++again) {
    const BeliefGrid loaded = load_vdb(path);
    expect_same(loaded, grid);
    EXPECT_EQ(loaded.notes(), notes);
    save_vdb(loaded, path);
  }
  save_vdb(grid, path, {.notes = MapNotes{}});  // in place of the map's own
  EXPECT_EQ(load_vdb(path).notes(), MapNotes{});
  EXPECT_EQ(grid.content_hash(), hash);
}

TEST(VdbIo, NotesThatCouldNotBeReadBackAreRefused) {
  BeliefGrid grid = seen_object(64);
  const MapNotes before = grid.notes();
  for (const char* identity : {"", "0123456789abcdef", "0123456789abcdef ", "0123456789ABCDEF a",
                               "0123456789abcdef0 a", "0123456789abcdef a\nb"}) {
    expect_error(ErrorCode::invalid_argument, "the identity of a frame must be",
                 [&] { grid.set_notes({.frames = {identity}}); });
  }
  for (const char* name : {"sensor", "frames"}) {
    expect_error(ErrorCode::invalid_argument, name, [&] {
      grid.set_notes({.others = {{name, "x"}}});
    });
  }
  EXPECT_EQ(grid.notes(), before);
}

TEST(VdbIo, RoundTripsAreExact) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  std::mt19937 random(41);
  const auto check = [&](const BeliefGrid& grid) {
    save_vdb(grid, path);
    const BeliefGrid loaded = load_vdb(path);
    expect_same(grid, loaded);
    save_vdb(grid, path, {.with_covariance = true});
    expect_same(grid, load_vdb(path));
    const std::string bytes = file_bytes(path);
    save_vdb(loaded, path, {.with_covariance = true});
    EXPECT_TRUE(file_bytes(path) == bytes);  // an equal map makes an equal file
  };
  check(seen_object(64));
  check(BeliefGrid(object_grid(16)));                                              // nothing known
  check(BeliefGrid(GridConfig{0.01, {{-20, -20, -20}, {20, 20, 20}}, {}, 0.01}));  // large
  // Tiles of 8³ and 128³ voxels, cut by the workspace, free and occupied.
  for (const std::uint8_t state : std::array<std::uint8_t, 2>{1, 2}) {
    const GridConfig config{0.01, {{-1.0, -0.05, 0.0}, {1.73, 1.3, 0.4}}, {}, 0.01};
    check(BeliefGrid::from_states(
        config, std::vector<std::uint8_t>(BeliefGrid(config).voxel_count(), state)));
  }
  for (const double share : {0.001, 0.3}) {
    const GridConfig config{0.01, {{5.03, -3.3, 0.0}, {5.4, -3.0, 0.21}}, {}, 0.01};
    std::vector<std::uint8_t> states(BeliefGrid(config).voxel_count(), 0);
    std::bernoulli_distribution other(share);
    std::uniform_int_distribution<int> which(1, 2);
    for (std::uint8_t& s : states) s = other(random) ? static_cast<std::uint8_t>(which(random)) : 0;
    check(BeliefGrid::from_states(config, states));
  }
  // Every log-odds, extreme and empty beliefs, many views.
  const float most = std::numeric_limits<float>::max();
  BeliefGrid grid(GridConfig{0.1, {{0, 0, 0}, {1, 1, 2}}, {}, 1e-3});
  for (int steps = -40; steps <= 70; ++steps) {
    const int n = steps + 40;
    const Index3 voxel{n % 10, n / 10 % 10, n / 100};
    grid.set(
        voxel, static_cast<float>(0.05 * steps),
        Belief{{1e-30F, most, 0.0F, -0.0F, -1e20F, 1e-40F}, {-3e38F, -0.0F, 1.1F}, 2147483647U});
    EXPECT_EQ(grid.log_odds(voxel).value(), static_cast<float>(0.05 * steps));
  }
  for (int i = 0; i < 100; ++i) grid.append_view(ring_view(i));
  check(grid);
}

// Of leaves that reach over the rim of the workspace, too, where perhaps nothing of them is known.
TEST(VdbIo, ScalesAtTheRimAreExact) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  const Sensor sensor = small_sensor(24, 18);
  std::mt19937 random(17);
  std::uniform_real_distribution<double> at(-1.5, 1.5);
  int cases = 0, scaled = 0;
  for (const int voxels : {9, 12, 20}) {
    const double half = 0.025 * voxels;
    for (int i = 0; i < 40; ++i, ++cases) {
      BeliefGrid grid(GridConfig{0.05, {{-half, -half, -half}, {half, half, half}}, {}, 0.1});
      FrameIntegrator integrator(sensor, {.coarsest = 2, .finest = 1 + i % 2});
      const Pose pose = look_at({at(random), at(random), at(random)}, {0, 0, 0});
      const float depth = 0.3F + 0.05F * static_cast<float>(i % 20);
      integrator.integrate(grid, {24, 18, std::vector<float>(24 * 18, depth)}, pose);
      save_vdb(grid, path);
      expect_same(load_vdb(path), grid);
      scaled += file_bytes(path).find("scale") != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_EQ(cases, 120);
  EXPECT_GT(scaled, 30);
}

TEST(VdbIo, VdbPrintListsTheGrids) {
  if (std::system("command -v vdb_print > /dev/null") != 0) GTEST_SKIP() << "no vdb_print";
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  const BeliefGrid grid = seen_object(40);
  const auto listing = [&](const VdbWriteConfig& config) {
    save_vdb(grid, path, config);
    FILE* pipe = ::popen(("vdb_print -l -m '" + path.string() + "' 2>&1").c_str(), "r");
    std::string text;
    std::array<char, 512> line;
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe) != nullptr)
      text += line.data();
    EXPECT_EQ(::pclose(pipe), 0);
    return text;
  };
  const std::string plain = listing({});
  for (const char* part :
       {"state", "log_odds", "information_diagonal", "information_offdiagonal",
        "information_vector", "hits", "float", "vec3s", "voxel_size", "prior_sigma",
        "workspace_min", "workspace_max", "T_world_grid", "views", "viewgain_version"}) {
    EXPECT_NE(plain.find(part), std::string::npos) << part << "\n" << plain;
  }
  EXPECT_EQ(plain.find("covariance"), std::string::npos);
  const std::string full = listing({.with_covariance = true});
  for (const char* part : {"covariance_diagonal", "covariance_offdiagonal", "mean_offset"}) {
    EXPECT_NE(full.find(part), std::string::npos) << part;
  }
}

TEST(VdbIo, VoxelsAreAsSmallAsCanBeSaved) {
  const TemporaryFolder folder;
  const auto grid = [](double voxel) {
    return BeliefGrid(GridConfig{
        voxel,
        {{0, 0, 0}, {20 * voxel, 20 * voxel, 20 * voxel}},
        Pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix(),
             Eigen::Vector3d(0.01, 0.02, 0.03)),
        voxel});
  };
  int cases = 0;
  for (const double voxel : {1e-300, 1e-5, 1.4e-5, 1.99e-5}) {
    expect_error(ErrorCode::invalid_argument, "voxel size", [&] { (void)grid(voxel); });
    ++cases;
  }
  {
    const CommaLocale commas;
    expect_error(ErrorCode::invalid_argument, "the voxel size is 1.4e-05 m; the minimum is",
                 [&] { (void)grid(1.4e-5); });
  }
  for (const double voxel : {2e-5, 1e-4, 1.0, 1e3}) {
    const auto path = folder.path() / "map.vdb";
    BeliefGrid small = grid(voxel);
    small.set({1, 2, 3}, 1.0F);
    save_vdb(small, path);
    expect_same(load_vdb(path), small);
    ++cases;
  }
  EXPECT_EQ(cases, 8);
}

TEST(VdbIo, TruncatedAtAnyLength) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  save_vdb(seen_object(24), path);
  const std::string whole = read_all(path);
  ASSERT_GT(whole.size(), 2000U);
  int cases = 0;
  // Every length in the header and close to the end, some in between.
  const auto step = [&](std::size_t length) {
    return length < 120 || length + 40 > whole.size() ? 1 : whole.size() / 100 + 1;
  };
  for (std::size_t length = 0; length < whole.size(); length += step(length)) {
    const auto cut = folder.file("cut.vdb", std::string_view(whole).substr(0, length));
    expect_error(ErrorCode::format, "cut.vdb", [&] { (void)load_vdb(cut); });
    ++cases;
  }
  EXPECT_GT(cases, 200);
}

TEST(VdbIo, CorruptAnywhere) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  save_vdb(seen_object(24), path);
  const std::string whole = read_all(path);
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> where(0, whole.size() - 25);  // before the seal
  for (int i = 0; i < 60; ++i) {
    std::string bytes = whole;
    bytes[where(random)] ^= static_cast<char>(1U << (i % 8));
    const auto bad = folder.file("bad.vdb", bytes);
    expect_error(ErrorCode::format, "bad.vdb", [&] { (void)load_vdb(bad); });
  }
  // Cut within the seal: refused as long as enough of it is left to know it by.
  for (std::size_t cut = 1; cut <= 20; ++cut) {
    const auto bad = folder.file("bad.vdb", whole.substr(0, whole.size() - cut));
    expect_error(ErrorCode::format, "bad.vdb", [&] { (void)load_vdb(bad); });
  }
  const auto longer = folder.file("longer.vdb", whole + "x");  // no seal at its end, but readable
  expect_same(load_vdb(longer), load_vdb(path));
}

TEST(VdbIo, MissingAndForeignFiles) {
  const TemporaryFolder folder;
  expect_error(ErrorCode::io, "none.vdb", [&] { (void)load_vdb(folder.path() / "none.vdb"); });
  expect_error(ErrorCode::io, folder.path().string(), [&] { (void)load_vdb(folder.path()); });
  for (const char* text : {"", "x", " BD", "solid thing\n", "\x89PNG\r\n"}) {
    expect_error(ErrorCode::format, "not an OpenVDB file",
                 [&] { (void)load_vdb(folder.file("text.vdb", text)); });
  }
  expect_error(ErrorCode::format, "a.vdb",
               [&] { (void)load_vdb(folder.file("a.vdb", " BDV" + std::string(500, '\0'))); });
  expect_error(ErrorCode::format, "a.vdb",
               [&] { (void)load_vdb(folder.file("a.vdb", " BDV" + std::string(500, '\xff'))); });
}

TEST(VdbIo, NothingIsLeftBehindWhenSavingFails) {
  const TemporaryFolder folder;
  const BeliefGrid grid(object_grid(8));
  expect_error(ErrorCode::io, "nowhere",
               [&] { save_vdb(grid, folder.path() / "nowhere" / "map.vdb"); });
  const auto taken = folder.path() / "folder.vdb";
  std::filesystem::create_directory(taken);
  expect_error(ErrorCode::io, "folder.vdb", [&] { save_vdb(grid, taken); });
  EXPECT_EQ(folder.entries(), 1);
  // An older file is replaced as a whole.
  const auto path = folder.file("map.vdb", "old");
  save_vdb(grid, path);
  expect_same(load_vdb(path), grid);
  EXPECT_EQ(folder.entries(), 2);
}

}  // namespace
}  // namespace viewgain
