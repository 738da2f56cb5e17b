// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "show/report/page.hpp"
#include "show/report/view_parts.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

using ordered_json = viewgain::app::Json;

// The other direction, by the words of apps/show/report/README.md.

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bits, bytes;
  for (const char c : text) {
    if (c == '=') continue;
    for (int b = 5; b >= 0; --b) bits += (digits.find(c) >> b & 1U) != 0 ? '1' : '0';
  }
  for (std::size_t i = 0; i + 8 <= bits.size(); i += 8) {
    bytes += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
  }
  return bytes;
}

std::string gunzipped(const std::string& packed, std::size_t size) {
  std::string bytes(size, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 16 + MAX_WBITS), Z_OK);
  std::string input = packed;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  std::string room(size + 1, '\0');
  stream.next_out = reinterpret_cast<Bytef*>(room.data());
  stream.avail_out = static_cast<uInt>(room.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.total_out, size);
  inflateEnd(&stream);
  return room.substr(0, size);
}

std::size_t bytes_of(const ordered_json& block) {
  const std::string type = block.at("type");
  return type == "u8" ? 1 : type == "u16" ? 2 : 4;
}

std::string content(const ordered_json& block) {
  const std::size_t count =
      block.at("rows").get<std::size_t>() * block.at("columns").get<std::size_t>();
  return gunzipped(from_base64(block.at("data")), count * bytes_of(block));
}

std::vector<std::uint64_t> integers(const ordered_json& block) {
  const std::size_t rows = block.at("rows"), columns = block.at("columns"), size = bytes_of(block);
  const std::string bytes = content(block);
  const std::uint64_t modulus = std::uint64_t{1} << (8 * size);
  std::vector<std::uint64_t> values(rows * columns);
  for (std::size_t c = 0; c < columns; ++c) {
    std::uint64_t value = 0;
    for (std::size_t r = 0; r < rows; ++r) {
      std::uint64_t code = 0;
      for (std::size_t b = 0; b < size; ++b) {
        const auto byte = static_cast<unsigned char>(bytes[(c * size + b) * rows + r]);
        code |= std::uint64_t{byte} << (8 * b);
      }
      const std::uint64_t step = code % 2 == 0 ? code / 2 : modulus - 1 - code / 2;
      value = (value + step) % modulus;
      values[r * columns + c] = value;
    }
  }
  return values;
}

TEST(ReportBlocks, Base64IsThatOfTheStandard) {
  // RFC 4648, section 10.
  const std::vector<std::pair<std::string, std::string>> cases{{"", ""},
                                                               {"f", "Zg=="},
                                                               {"fo", "Zm8="},
                                                               {"foo", "Zm9v"},
                                                               {"foob", "Zm9vYg=="},
                                                               {"fooba", "Zm9vYmE="},
                                                               {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : cases) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(ReportBlocks, IntegersComeBack) {
  std::mt19937_64 random(1);
  int cases = 0;
  for (const std::size_t rows : {0U, 1U, 2U, 1000U}) {
    for (const std::size_t columns : {1U, 3U}) {
      std::vector<std::uint32_t> values(rows * columns);
      for (std::uint32_t& v : values) v = static_cast<std::uint32_t>(random());
      if (values.size() > 1) values[0] = 0, values[1] = std::numeric_limits<std::uint32_t>::max();
      const std::vector<std::uint64_t> back = integers(index_block(values, columns));
      ASSERT_EQ(back.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(back[i], values[i]) << i;
      ++cases;
    }
  }
  std::vector<std::uint8_t> bytes(512);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(37 * i);
  const std::vector<std::uint64_t> back = integers(byte_block(bytes));
  for (std::size_t i = 0; i < bytes.size(); ++i) ASSERT_EQ(back[i], bytes[i]) << i;
  EXPECT_EQ(++cases, 9);
}

TEST(ReportBlocks, FloatsComeBackBitForBit) {
  const std::vector<float> values{0.0F,  -1.5F,  std::numeric_limits<float>::quiet_NaN(),
                                  3e38F, 1e-40F, std::numeric_limits<float>::infinity()};
  const ordered_json block = float_block(values, 3);
  EXPECT_EQ(block.at("rows"), 2);
  const std::string bytes = content(block);
  EXPECT_EQ(std::memcmp(bytes.data(), values.data(), bytes.size()), 0);
}

TEST(ReportBlocks, PointsAreWithinHalfAStep) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-0.3, 0.7);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(uniform(random), 1e-3 * uniform(random), 2.0);
  const ordered_json block = point_block(points);
  const std::vector<std::uint64_t> levels = integers(block);
  int checked = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double step = block.at("step").at(c), min = block.at("min").at(c);
      EXPECT_LT(levels[3 * i + c], 65535U);
      EXPECT_NEAR(min + step * static_cast<double>(levels[3 * i + c]),
                  points[i][static_cast<Eigen::Index>(c)], 0.5 * step + 1e-12);
      ++checked;
    }
  }
  EXPECT_EQ(checked, 1500);
  EXPECT_EQ(block.at("step").at(2), 0.0);
  EXPECT_EQ(point_block({}).at("rows"), 0);
}

TEST(ReportBlocks, ShadesKeepWhatIsNotFinite) {
  const ordered_json block = shade_block({1.0, std::nan(""), 3.0, 2.0});
  const std::vector<std::uint64_t> levels = integers(block);
  EXPECT_EQ(levels, (std::vector<std::uint64_t>{0, 255, 254, 127}));
  EXPECT_DOUBLE_EQ(block.at("min").at(0), 1.0);
  EXPECT_DOUBLE_EQ(block.at("step").at(0), 2.0 / 254);
}

TEST(ReportPage, NothingInTheDataEndsItsElement) {
  const std::string page = "<script id=\"data\">__VIEWGAIN_DATA__</script><p>after</p>";
  const ordered_json data{{"title", "a</script><script>alert('\"&')</script><!--"},
                          {"bad", "\xff"}};
  const std::string text = report_page(data, page);
  const std::size_t begin = std::string("<script id=\"data\">").size();
  const std::size_t end = text.find("</script><p>after</p>");
  ASSERT_NE(end, std::string::npos);
  const std::string inside = text.substr(begin, end - begin);
  EXPECT_EQ(inside.find('<'), std::string::npos);
  EXPECT_EQ(ordered_json::parse(inside).at("title"), data.at("title"));
  EXPECT_EQ(ordered_json::parse(inside).at("bad"), "\xef\xbf\xbd");
}

TEST(ReportPage, NeedsOnePlaceForTheData) {
  for (const char* page : {"", "<p>no place</p>", "__VIEWGAIN_DATA__ __VIEWGAIN_DATA__"}) {
    EXPECT_THROW((void)report_page({}, page), Error) << page;
  }
}

// A lattice of side x side vertices in a plane, 1 mm apart.
ShownMesh lattice(std::uint32_t side) {
  ShownMesh mesh;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      mesh.vertices.emplace_back(1e-3 * i, 1e-3 * j, 0);
      mesh.sigma.push_back(1e-3 * i);
      if (i + 1 == side || j + 1 == side) continue;
      const std::uint32_t a = j * side + i;
      mesh.triangles.push_back({a, a + 1, a + side});
      mesh.triangles.push_back({a + 1, a + side + 1, a + side});
    }
  }
  return mesh;
}

TEST(ShownMesh, IsThinnedToWhatWasAsked) {
  const ShownMesh mesh = lattice(100);
  const ShownMesh same = thinned(mesh, 10'000);
  EXPECT_EQ(same.vertices.size(), 10'000U);
  EXPECT_EQ(same.triangles, mesh.triangles);
  for (const std::size_t most : {5'000U, 1'000U, 50U, 1U}) {
    const ShownMesh thin = thinned(mesh, most);
    EXPECT_LE(thin.vertices.size(), most);
    EXPECT_GE(4 * thin.vertices.size(), most);
    ASSERT_EQ(thin.sigma.size(), thin.vertices.size());
    EXPECT_TRUE(thin.error.empty());
    double area = 0;
    for (const auto& t : thin.triangles) {
      for (const std::uint32_t v : t) ASSERT_LT(v, thin.vertices.size());
      area += 0.5 * (thin.vertices[t[1]] - thin.vertices[t[0]])
                        .cross(thin.vertices[t[2]] - thin.vertices[t[0]])
                        .z();
    }
    // The plane stays covered but for half a cell at its edges, and what a vertex carries stays
    // that of its place.
    if (most >= 1'000) {
      EXPECT_NEAR(area, 99e-3 * 99e-3, 0.1 * 99e-3 * 99e-3) << most;
    }
    for (std::size_t i = 0; i < thin.vertices.size(); ++i) {
      EXPECT_NEAR(thin.sigma[i], thin.vertices[i].x(), 1e-12);
    }
  }
}

}  // namespace
}  // namespace viewgain::app
