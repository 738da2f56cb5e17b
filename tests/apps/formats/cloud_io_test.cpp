// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Clouds in files: each format as others write it, cut files and forged headers.

#include "viewgain/formats/cloud_io.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain {
namespace {

using namespace test;
using namespace std::string_literals;

template <typename T>
std::string raw(T value, bool big_endian = false) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string pcd_header(const std::string& data, std::size_t points) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS intensity x normal y z\n"
         "SIZE 2 4 4 8 4\nTYPE U F F F I\nCOUNT 1 1 3 1 1\nWIDTH " +
         n + "\nHEIGHT 1\nVIEWPOINT 1 2 3 0 1 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

/// x single, y double, z a whole number: what the files can say exactly.
std::vector<std::array<double, 3>> some_points() {
  std::vector<std::array<double, 3>> points;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(-5, 5);
  for (int i = 0; i < 50; ++i) {
    points.push_back({static_cast<double>(static_cast<float>(value(random))), value(random),
                      static_cast<double>(i % 3 - 1)});
  }
  points[7][0] = std::numeric_limits<double>::quiet_NaN();
  points[9][1] = std::numeric_limits<double>::infinity();
  return points;
}

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

std::string pcd_ascii() {
  std::string file = pcd_header("ascii", 50);
  for (const auto& p : some_points()) {
    (file += "12 ") += text(p[0]) + " 0 0 1 " + text(p[1]) + " " + text(p[2]) + "\n";
  }
  return file;
}

std::string pcd_binary() {
  std::string file = pcd_header("binary", 50);
  for (const auto& p : some_points()) {
    file += raw<std::uint16_t>(12) + raw(static_cast<float>(p[0])) + std::string(12, 'n') +
            raw(p[1]) + raw(static_cast<std::int32_t>(p[2]));
  }
  return file;
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by a test\nelement camera 2\nproperty float fx\n"
         "property list uchar short names\nelement vertex 50\nproperty uchar red\n"
         "property float x\nproperty double y\nproperty list uint int more\n"
         "property int z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string ply_ascii() {
  std::string file = ply_header("ascii") + "1.5 2 7 8\n2.5 0\n";
  for (const auto& p : some_points()) {
    (file += "255 ") += text(p[0]) + " " + text(p[1]) + " 2 5 6 " + text(p[2]) + "\n";
  }
  return file + "3 0 1 2\n";
}

std::string ply_binary(bool big) {
  std::string file = ply_header(big ? "binary_big_endian" : "binary_little_endian");
  file +=
      raw(1.5F, big) + raw<std::uint8_t>(2) + raw<std::int16_t>(7, big) + raw<std::int16_t>(8, big);
  file += raw(2.5F, big) + raw<std::uint8_t>(0);
  for (const auto& p : some_points()) {
    file += raw<std::uint8_t>(255) + raw(static_cast<float>(p[0]), big) + raw(p[1], big) +
            raw<std::uint32_t>(2, big) + raw<std::int32_t>(5, big) + raw<std::int32_t>(6, big) +
            raw(static_cast<std::int32_t>(p[2]), big);
  }
  return file + raw<std::uint8_t>(3) + std::string(12, '\1');
}

class CloudFiles : public testing::Test {
 protected:
  void expect_points(const std::string& name, const std::string& contents) {
    const PointCloud cloud = load_cloud(folder_.file(name, contents));
    const auto points = some_points();
    ASSERT_EQ(cloud.points.size(), points.size());
    int differences = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        const double x = cloud.points[i][a], y = points[i][a];
        if (!(x == y || (std::isnan(x) && std::isnan(y)))) ++differences;
      }
    }
    EXPECT_EQ(differences, 0) << name;
    EXPECT_EQ(cloud.viewpoint.has_value(), name.ends_with(".pcd"));
    if (cloud.viewpoint) {
      // Half a turn about x.
      EXPECT_EQ(cloud.viewpoint->m, (std::array<double, 12>{1, 0, 0, 1, 0, -1, 0, 2, 0, 0, -1, 3}));
    }
    ++cases_;
  }

  void expect_refused(const std::string& name, const std::string& part,
                      const std::string& contents) {
    const auto path = folder_.file(name, contents);
    expect_error(ErrorCode::format, part, [&] { (void)load_cloud(path); });
    expect_error(ErrorCode::format, name, [&] { (void)load_cloud(path); });
    ++cases_;
  }

  TemporaryFolder folder_;
  int cases_ = 0;
};

TEST_F(CloudFiles, EveryFormatIsReadExactly) {
  expect_points("ascii.pcd", pcd_ascii());
  expect_points("binary.pcd", pcd_binary());
  expect_points("ascii.ply", ply_ascii());
  expect_points("little.ply", ply_binary(false));
  expect_points("big.ply", ply_binary(true));
  // Windows' ends of lines; no COUNT is one each; an organised cloud.
  expect_points("crlf.pcd", replaced(pcd_ascii(), "\n", "\r\n"));
  expect_points("organised.pcd",
                with(with(pcd_binary(), "WIDTH 50", "WIDTH 10"), "HEIGHT 1", "HEIGHT 5"));
  // Padding as drivers have it, and fields of no numbers.
  expect_points("padded.pcd", with(pcd_binary(), "x normal y z", "x _ y z"));
  expect_points(
      "count_0.pcd",
      with(with(with(with(pcd_ascii(), "normal y z", "normal y z _ _"), "4 8 4\n", "4 8 4 1 1\n"),
                "F F I\n", "F F I U U\n"),
           "3 1 1\n", "3 1 1 0 0\n"));
  expect_points("cr.pcd", replaced(pcd_ascii(), "\n", "\r"));
  expect_points("broken.ply", replaced(ply_ascii(), " 2 5 6 ", "\n 2 5 6\n"));
  expect_points("cr.ply", replaced(ply_ascii(), "\n", "\r"));
  // A byte order mark; comments among the points.
  for (const std::string& file : {pcd_ascii(), pcd_binary()}) {
    expect_points("marked.pcd", "\xEF\xBB\xBF" + file);
  }
  expect_points("comments.pcd", with(with(pcd_ascii(), "DATA ascii\n", "DATA ascii\n# one\n"),
                                     "\n12 ", "\n  #two of them\n12 "));
  const PointCloud small = load_cloud(folder_.file(
      "small.pcd",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n1 2 3\n\nnan 0 +4\n"));
  EXPECT_FALSE(small.viewpoint.has_value());
  ASSERT_EQ(small.points.size(), 2U);
  EXPECT_EQ(small.points[0], (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(small.points[1][2], 4);
  EXPECT_TRUE(load_cloud(folder_.file("empty.ply",
                                      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                                      "property float y\nproperty float z\nend_header\n"))
                  .points.empty());
}

TEST_F(CloudFiles, ViewpointsWithoutARotation) {
  const auto viewpoint = [&](const std::string& numbers) {
    return load_cloud(folder_.file("view.pcd", with(pcd_ascii(), "1 2 3 0 1 0 0", numbers)))
        .viewpoint;
  };
  EXPECT_EQ(viewpoint("0 0 0 0 0 0 0")->m, Pose().m);
  EXPECT_EQ(viewpoint("1 2 3 0 0 0 -0.0")->translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(viewpoint("0 0 0 0 0 0 1")->m,
            (std::array<double, 12>{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0}));
}

TEST_F(CloudFiles, EveryCutIsRefused) {
  const std::string files[]{pcd_ascii(), pcd_binary(), ply_ascii(), ply_binary(false),
                            ply_binary(true)};
  int expected = 0;
  for (const std::string& file : files) {
    const bool ply = file.starts_with("ply");
    const std::string name = ply ? "cut.ply" : "cut.pcd";
    // What stands behind a PLY's vertices is not looked at; the last digits of the last number of
    // a text are as good as the whole.
    const std::size_t tail = &file == &files[2] ? 9 : ply ? 13 : &file == &files[0] ? 1 : 0;
    for (std::size_t length = 0; length + tail < file.size(); ++length, ++expected) {
      expect_refused(name, "", file.substr(0, length));
    }
  }
  EXPECT_EQ(cases_, expected);
  EXPECT_GT(cases_, 4000);
}

TEST_F(CloudFiles, ForgedPcdHeadersAreNamedByLine) {
  const std::string good = pcd_binary();
  const auto change = [&](const std::string& part, const std::string& from, const std::string& to) {
    expect_refused("bad.pcd", part, with(good, from, to));
  };
  change("bad.pcd:10: the count '99999999999'", "POINTS 50", "POINTS 99999999999");
  change("differs from WIDTH x HEIGHT", "POINTS 50", "POINTS 51");
  change("bad.pcd:10: '-5' is not a whole number", "POINTS 50", "POINTS -5");
  change("'5e1' is not", "POINTS 50", "POINTS 5e1");
  change("a number is missing", "POINTS 50", "POINTS");
  change("bad.pcd:7:", "WIDTH 50", "WIDTH -1");
  change("WIDTH x HEIGHT is too large", "WIDTH 50\nHEIGHT 1",
         "WIDTH 4294967295\nHEIGHT 4294967295");
  change("bytes follow", "WIDTH 50\nHEIGHT 1\nVIEWPOINT 1 2 3 0 1 0 0\nPOINTS 50",
         "WIDTH 4294967295\nHEIGHT 1\nPOINTS 4294967295");
  change("only one of WIDTH and HEIGHT", "HEIGHT 1", "# none");
  change("neither POINTS nor WIDTH and HEIGHT",
         "WIDTH 50\nHEIGHT 1\nVIEWPOINT 1 2 3 0 1 0 0\nPOINTS 50", "# none");
  change("missing field 'z'", "y z\n", "y w\n");
  change("'x' must have COUNT 1", "COUNT 1 1 3", "COUNT 1 2 3");
  change("the count '100001' is too large", "COUNT 1 1 3", "COUNT 1 1 100001");
  change("bytes follow", "COUNT 1 1 3", "COUNT 1 1 100000");
  change("must have one word for each of the 5 fields", "SIZE 2 4 4 8 4", "SIZE 2 4 4 8");
  change("must have one word for each", "TYPE U F F F I", "TYPE U F F F I I");
  change("bad.pcd:5: TYPE must be F, I or U, not 'D'", "TYPE U F", "TYPE U D");
  change("SIZE that does not fit its TYPE", "SIZE 2 4", "SIZE 2 2");
  change("SIZE that does not fit its TYPE", "SIZE 2 4", "SIZE 3 4");
  change("SIZE that does not fit its TYPE", "SIZE 2 4", "SIZE 0 4");
  change("is too large", "SIZE 2 4", "SIZE 2 9");
  change("no line SIZE", "SIZE 2 4 4 8 4", "# none");
  change("the field 'x' is declared twice", "intensity x normal y z", "x x normal y z");
  change("FIELDS must come first", "FIELDS intensity x normal y z\n", "");
  change("FIELDS is declared twice", "VERSION 0.7", "FIELDS x y z");
  change("FIELDS needs", "FIELDS intensity x normal y z", "FIELDS");
  change("VIEWPOINT needs 7", "VIEWPOINT 1 2 3 0 1 0 0", "VIEWPOINT 1 2 3");
  change("bad.pcd:9: the quaternion of VIEWPOINT", "0 1 0 0\n", "0 2 0 0\n");
  change("the number 'nan' is not finite", "VIEWPOINT 1", "VIEWPOINT nan");
  change("DATA must be ascii or binary, not 'bin'", "DATA binary", "DATA bin\n");
  change("pcl_convert_pcd_ascii_binary", "DATA binary", "DATA binary_compressed");
  change("no line DATA", good.substr(good.find("DATA")), "");
  change("the header's keyword 'ply' is unknown", "VERSION 0.7", "ply");

  const std::string ascii = pcd_ascii();
  expect_refused("bad.pcd", "bad.pcd:12: expected 7 words for a point; found 6",
                 with(ascii, "\n12 ", "\n"));
  expect_refused("bad.pcd", "the file continues after its last point", ascii + "1 2 3 4 5 6 7\n");
  expect_refused("bad.pcd", "bad.pcd:12: 'zero", with(ascii, " 0 0 1 ", " 0 0 1 zero"));
}

// What meshes' headers may have wrong, too, is in mesh_dialects.cpp: the reader is the same.
TEST_F(CloudFiles, ForgedPlyHeadersAreNamedByLine) {
  const std::string good = ply_binary(false);
  const auto change = [&](const std::string& part, const std::string& from, const std::string& to) {
    expect_refused("bad.ply", part, with(good, from, to));
  };
  change("bad.ply:7: the count '99999999999'", "vertex 50", "vertex 99999999999");
  change("'-1' is not a whole number", "vertex 50", "vertex -1");
  change("the file ends", "vertex 50", "vertex 4294967295");
  change("the file ends", "camera 2", "camera 4294967295");
  change("bad.ply:2: the format 'binary'", "binary_little_endian", "binary");
  change("no format line", "format binary_little_endian 1.0", "comment");
  change("a property needs a type and a name", "float x", "float");
  change("a property needs a type and a name", "float x", "float x y");
  change("a list's count must be a whole number", "list uchar short", "list float short");
  change("an element needs", "element camera 2", "element camera");
  change("the header's keyword 'property,'", "property float fx", "property, float fx");
  change("no line end_header", good.substr(good.find("end_header")), "");
  expect_refused("bad.ply", "bad.ply:10: the file continues",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n1 2 3\n\n4 5 6\n");
  // A list of 2^32 - 1 numbers, one of a negative count.
  std::string list = good;
  list.replace(good.find("end_header\n") + 11 + 14 + 13, 4, raw<std::uint32_t>(4294967295U));
  expect_refused("bad.ply", "the file ends", list);
  expect_refused("bad.ply", "negative count",
                 with(with(good, "list uint int more", "list int int more"),
                      raw<std::uint32_t>(2) + raw<std::int32_t>(5),
                      raw<std::int32_t>(-2) + raw<std::int32_t>(5)));
  const std::string ascii = ply_ascii();
  expect_refused("bad.ply", "bad.ply:17: '2.5' is not", with(ascii, "1.5 2 7 8", "1.5 9 7 8"));
}

TEST_F(CloudFiles, FilesThatCannotBeReadAreNamed) {
  expect_error(ErrorCode::io, "none.pcd", [&] { (void)load_cloud(folder_.path() / "none.pcd"); });
  expect_error(ErrorCode::format, ".pcd or .ply", [&] { (void)load_cloud("cloud.xyz"); });
  // A file of which nothing can be read.
  for (const char* name : {"mem.pcd", "mem.ply", "mem.ot", "mem.vdb"}) {
    const auto path = folder_.path() / name;
    std::filesystem::create_symlink("/proc/self/mem", path);
    expect_error(ErrorCode::io, name, [&] {
      if (path.extension() == ".vdb") {
        (void)load_vdb(path);
      } else if (path.extension() == ".ot") {
        (void)load_octomap(path);
      } else {
        (void)load_cloud(path);
      }
    });
  }
}

}  // namespace
}  // namespace viewgain
