// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// OctoMap files that are cut, forged or of another kind.

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <cmath>
#include <cstring>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/formats/octomap_io.hpp"

namespace viewgain {
namespace {

using namespace test;

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
  expect_refused(":1: is no OctoMap file", "");
  expect_refused(":1: is no OctoMap file", "ply\nformat ascii 1.0\n");
  expect_refused(":1: is no OctoMap file", std::string(1000, '\0'));
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
