// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/cloud_io.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/ply_file.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr std::uint64_t kMostPoints = std::numeric_limits<std::uint32_t>::max();
constexpr double kMendableNorm = 1e-2;

struct Field {
  std::string_view name;
  ScalarType type;
  std::size_t count = 1;
  std::size_t begin = 0;  ///< in a point [bytes]
  std::size_t word = 0;   ///< in a line
};

enum class Data { none, ascii, binary };

struct Header {
  std::vector<Field> fields;
  std::size_t point_bytes = 0, point_words = 0;
  std::uint64_t points = 0;
  std::optional<Pose> viewpoint;
  Data data = Data::none;
  std::array<std::size_t, 3> xyz{};  ///< positions in `fields`
};

void read_kinds(const LineReader& line, std::vector<Field>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view word = line.words()[i + 1];
    using Kind = ScalarType::Kind;
    if (word == "F") {
      fields[i].type.kind = Kind::floating;
    } else if (word == "I") {
      fields[i].type.kind = Kind::signed_integer;
    } else if (word == "U") {
      fields[i].type.kind = Kind::unsigned_integer;
    } else {
      line.fail("TYPE must be F, I or U, not " + quoted(word));
    }
  }
}

Pose read_viewpoint(const LineReader& line) {
  std::array<double, 7> v{};
  if (line.words().size() != 8) line.fail("VIEWPOINT needs 7 numbers: tx ty tz qw qx qy qz");
  for (std::size_t i = 0; i < 7; ++i) v[i] = line.finite_number(i + 1);
  Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  // Drivers without a rotation write zeros.
  if (q.squaredNorm() == 0) q.setIdentity();
  if (!(std::abs(q.norm() - 1) <= kMendableNorm)) {
    line.fail("the quaternion of VIEWPOINT has norm " + short_text(q.norm()) + "; expected 1");
  }
  return {q.normalized().toRotationMatrix(), Eigen::Vector3d(v[0], v[1], v[2])};
}

/// Computes the positions of the fields, and finds x, y, z.
void lay_out(const LineReader& line, Header& header) {
  for (Field& field : header.fields) {
    if (!field.type.is_known()) {
      line.fail("the field " + quoted(field.name) + " has a SIZE that does not fit its TYPE");
    }
    field.begin = header.point_bytes;
    field.word = header.point_words;
    header.point_bytes += field.count * field.type.size;
    header.point_words += field.count;
  }
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto is_axis = [&](const Field& f) { return f.name == kNames[axis]; };
    const auto found = std::find_if(header.fields.begin(), header.fields.end(), is_axis);
    if (found == header.fields.end()) line.fail("missing field " + quoted(kNames[axis]));
    if (std::any_of(found + 1, header.fields.end(), is_axis)) {
      line.fail("the field " + quoted(kNames[axis]) + " is declared twice");
    }
    if (found->count != 1) line.fail("the field " + quoted(kNames[axis]) + " must have COUNT 1");
    header.xyz[axis] = static_cast<std::size_t>(found - header.fields.begin());
  }
}

/// Reads up to the line DATA, after which the points begin.
Header read_header(LineReader& line) {
  Header header;
  std::uint64_t width = 0, height = 0;
  bool has_width = false, has_height = false, has_points = false, has_sizes = false;
  constexpr std::size_t kMostFields = 1000;
  constexpr std::size_t kMostCount = 100000;
  while (header.data == Data::none) {
    if (!line.next()) line.fail("the header is truncated; it has no line DATA");
    const auto& words = line.words();
    if (words.empty() || words[0].front() == '#' || words[0] == "VERSION") continue;
    const auto each_field = [&](auto&& read) {
      if (header.fields.empty()) line.fail("FIELDS must come first");
      if (words.size() != header.fields.size() + 1) {
        line.fail(std::string(words[0]) + " must have one word for each of the " +
                  std::to_string(header.fields.size()) + " fields");
      }
      for (std::size_t i = 0; i < header.fields.size(); ++i) read(header.fields[i], i + 1);
    };
    if (words[0] == "FIELDS" || words[0] == "COLUMNS") {
      if (!header.fields.empty()) line.fail("FIELDS is declared twice");
      if (words.size() < 2 || words.size() > kMostFields) line.fail("FIELDS needs 1 to 999 names");
      for (std::size_t i = 1; i < words.size(); ++i) header.fields.push_back({words[i], {}});
    } else if (words[0] == "SIZE") {
      each_field([&](Field& field, std::size_t i) { field.type.size = line.count(i, 8); });
      has_sizes = true;
    } else if (words[0] == "TYPE") {
      each_field([](Field&, std::size_t) {});
      read_kinds(line, header.fields);
    } else if (words[0] == "COUNT") {
      each_field([&](Field& field, std::size_t i) { field.count = line.count(i, kMostCount); });
    } else if (words[0] == "WIDTH") {
      width = line.count(1, kMostPoints);
      has_width = true;
    } else if (words[0] == "HEIGHT") {
      height = line.count(1, kMostPoints);
      has_height = true;
    } else if (words[0] == "POINTS") {
      header.points = line.count(1, kMostPoints);
      has_points = true;
    } else if (words[0] == "VIEWPOINT") {
      header.viewpoint = read_viewpoint(line);
    } else if (words[0] == "DATA") {
      const std::string_view data = words.size() > 1 ? words[1] : std::string_view();
      header.data = data == "ascii" ? Data::ascii : data == "binary" ? Data::binary : Data::none;
      if (header.data == Data::none) {
        line.fail("DATA must be ascii or binary, not " + quoted(data) +
                  "; convert the file with pcl_convert_pcd_ascii_binary");
      }
    } else {
      line.fail("the header's keyword " + quoted(words[0]) + " is unknown");
    }
  }
  if (!has_sizes) line.fail("the header has no line SIZE");
  if (has_width != has_height) line.fail("the header has only one of WIDTH and HEIGHT");
  if (!has_width && !has_points) line.fail("the header has neither POINTS nor WIDTH and HEIGHT");
  if (height != 0 && width > kMostPoints / height) line.fail("WIDTH x HEIGHT is too large");
  if (!has_points) header.points = width * height;
  if (has_width && header.points != width * height) {
    line.fail("POINTS " + std::to_string(header.points) + " differs from WIDTH x HEIGHT");
  }
  lay_out(line, header);
  return header;
}

void read_ascii(LineReader& line, const Header& header,
                std::vector<std::array<double, 3>>& points) {
  while (points.size() < header.points) {
    if (!line.next()) {
      line.fail("the file ends after " + std::to_string(points.size()) + " of " +
                std::to_string(header.points) + " points");
    }
    if (line.words().empty() || line.words()[0].front() == '#') continue;
    if (line.words().size() != header.point_words) {
      line.fail("expected " + std::to_string(header.point_words) + " words for a point; found " +
                std::to_string(line.words().size()));
    }
    auto& point = points.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) point[a] = line.number(header.fields[header.xyz[a]].word);
  }
  while (line.next()) {
    if (line.words().empty() || line.words()[0].front() == '#') continue;
    line.fail("the file continues after its last point");
  }
}

void read_binary(const LineReader& line, const Header& header,
                 std::vector<std::array<double, 3>>& points) {
  // The product stays below 2^64: at most 2^32 points of 999 fields of 800,000 bytes.
  const std::string_view data = line.rest();
  if (header.points * header.point_bytes > data.size()) {
    throw Error(ErrorCode::format,
                line.name() + ": the header declares " + std::to_string(header.points) +
                    " points of " + std::to_string(header.point_bytes) + " bytes each, but only " +
                    std::to_string(data.size()) + " bytes follow");
  }
  points.resize(header.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Field& field = header.fields[header.xyz[a]];
      points[i][a] = decode(data.data() + i * header.point_bytes + field.begin, field.type);
    }
  }
}

PointCloud parse_pcd(std::string_view bytes, const std::string& name) {
  LineReader line(name, bytes);
  const Header header = read_header(line);
  PointCloud cloud;
  cloud.viewpoint = header.viewpoint;
  if (header.data == Data::ascii) {
    read_ascii(line, header, cloud.points);
  } else {
    read_binary(line, header, cloud.points);
  }
  return cloud;
}

PointCloud parse_ply(std::string_view bytes, const std::string& name) {
  PlyFile file(bytes, name);
  const auto& elements = file.elements();
  const auto vertices = std::find_if(elements.begin(), elements.end(),
                                     [](const PlyElement& e) { return e.name == "vertex"; });
  if (vertices == elements.end()) file.fail("the element \"vertex\" is missing");
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  std::array<std::size_t, 3> xyz{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto property = vertices->find(kNames[a], false);
    if (!property) file.fail("the vertices have no property " + quoted(kNames[a]));
    xyz[a] = *property;
  }
  PointCloud cloud;
  const auto number = static_cast<std::size_t>(vertices - elements.begin());
  // Elements after the vertices are not read.
  file.read(number + 1, [&](std::size_t element, const PlyRow& row) {
    if (element != number) return;
    cloud.points.push_back({row.scalar(xyz[0]), row.scalar(xyz[1]), row.scalar(xyz[2])});
  });
  return cloud;
}

}  // namespace

PointCloud load_cloud(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  const bool is_pcd = ending == ".pcd" || ending == ".PCD";
  if (!is_pcd && ending != ".ply" && ending != ".PLY") {
    throw Error(ErrorCode::format,
                path.string() + ": a point cloud must have the ending .pcd or .ply");
  }
  const std::string bytes = file_bytes(path);
  return is_pcd ? parse_pcd(bytes, path.string()) : parse_ply(bytes, path.string());
}

}  // namespace viewgain
