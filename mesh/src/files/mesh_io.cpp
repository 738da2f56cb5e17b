// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// CGAL's assertions print before they throw; what they guard is checked here before or afterwards.
#define CGAL_NDEBUG 1

#include "viewgain/mesh/mesh_io.hpp"

#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "mesh_file_checks.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/text.hpp"

namespace viewgain {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;

// Containers that refuse to grow to what no file of this size can hold; CGAL resizes them to
// whatever a header says.
struct GuardedPoints : std::vector<Point> {
  std::size_t limit = 0;
  void resize(std::size_t count) {
    if (count > limit) {
      throw Error(ErrorCode::format, "the header promises " + std::to_string(count) +
                                         " vertices, more than the file can hold");
    }
    std::vector<Point>::resize(count);
  }
};

struct Polygon : std::vector<std::size_t> {
  static constexpr std::size_t kMaxCorners = 65536;
  void resize(std::size_t count) {
    if (count > kMaxCorners) {
      throw Error(ErrorCode::format, "a face with " + std::to_string(count) + " corners");
    }
    std::vector<std::size_t>::resize(count);
  }
};

struct GuardedPolygons : std::vector<Polygon> {
  std::size_t limit = 0;
  void resize(std::size_t count) {
    if (count > limit) {
      throw Error(ErrorCode::format, "the header promises " + std::to_string(count) +
                                         " faces, more than the file can hold");
    }
    std::vector<Polygon>::resize(count);
  }
};

std::string read_bytes(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw Error(ErrorCode::io, name + ": no such file");
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ErrorCode::io, name + ": not a regular file");
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  if (!file) throw Error(ErrorCode::io, name + ": cannot be opened");
  if (file.peek() != std::ifstream::traits_type::eof()) bytes << file.rdbuf();
  if (file.bad() || !bytes) throw Error(ErrorCode::io, name + ": cannot be read");
  return std::move(bytes).str();
}

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool read_soup(const std::string& extension, std::string bytes, const std::string& name,
               GuardedPoints& points, GuardedPolygons& polygons) {
  const auto quiet = CGAL::parameters::verbose(false);
  // The shortest vertex line is "0 0 0", the shortest face that has an area "3 0 1 2".
  points.limit = bytes.size() / 6 + 1;
  polygons.limit = bytes.size() / 6 + 1;
  if (extension == ".off") {
    detail::check_off(bytes, name);
    std::istringstream stream(std::move(bytes));
    return CGAL::IO::read_OFF(stream, points, polygons, quiet);
  }
  if (extension == ".ply") {
    detail::check_ply(bytes, name);
    std::istringstream stream(std::move(bytes));
    return CGAL::IO::read_PLY(stream, points, polygons, quiet);
  }
  if (extension == ".stl") {
    detail::check_stl(bytes, name);
    std::istringstream stream(std::move(bytes));
    return CGAL::IO::read_STL(stream, points, polygons, quiet);
  }
  detail::check_obj(bytes, name);
  std::istringstream stream(std::move(bytes));
  return CGAL::IO::read_OBJ(stream, points, polygons, quiet);
}

// Why a file could not be parsed, as far as a look at its words tells.
std::string parse_failure(const std::string& bytes, const std::string& extension) {
  std::istringstream words(bytes);
  bool has_face = extension != ".obj";  // CGAL's OBJ reader calls a file without faces unreadable
  for (std::string word; words >> word;) {
    std::transform(word.begin(), word.end(), word.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (word == "nan" || word == "-nan" || word == "inf" || word == "-inf") {
      return "a coordinate is not finite (\"" + word + "\")";
    }
    if (word == "f") has_face = true;
  }
  if (!has_face) return "the mesh has no faces";
  return "cannot be parsed: a line is missing or not what it should be, or an index is out of "
         "range";
}

TriangleMesh triangulated(const GuardedPoints& points, const GuardedPolygons& polygons,
                          const std::string& name) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::format, name + ": more than 2^32 vertices");
  }
  TriangleMesh mesh;
  mesh.vertices.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::array<double, 3> p{points[i].x(), points[i].y(), points[i].z()};
    for (const double x : p) {
      if (!std::isfinite(x)) {
        throw Error(ErrorCode::format,
                    name + ": a coordinate of vertex " + std::to_string(i) + " is not finite");
      }
    }
    mesh.vertices.push_back(p);
  }
  for (std::size_t f = 0; f < polygons.size(); ++f) {
    const Polygon& polygon = polygons[f];
    for (const std::size_t index : polygon) {
      if (index >= points.size()) {
        throw Error(ErrorCode::format, name + ": face " + std::to_string(f) +
                                           " has an index out of range, the file has " +
                                           std::to_string(points.size()) + " vertices");
      }
    }
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      mesh.triangles.push_back({static_cast<std::uint32_t>(polygon[0]),
                                static_cast<std::uint32_t>(polygon[i - 1]),
                                static_cast<std::uint32_t>(polygon[i])});
    }
  }
  if (mesh.triangles.empty()) throw Error(ErrorCode::format, name + ": the mesh has no faces");
  return mesh;
}

struct Bounds {
  std::array<double, 3> min, max;
};

Bounds bounds_of(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Bounds bounds{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const auto& vertex : mesh.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.min[k] = std::min(bounds.min[k], vertex[k]);
      bounds.max[k] = std::max(bounds.max[k], vertex[k]);
    }
  }
  return bounds;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string extension = lower_case_extension(path);
  if (extension != ".off" && extension != ".obj" && extension != ".stl" && extension != ".ply") {
    throw Error(ErrorCode::format, name + ": not a mesh file (.off, .obj, .stl, .ply)");
  }
  const std::string bytes = read_bytes(path);
  if (bytes.empty()) throw Error(ErrorCode::format, name + ": the file is empty");

  GuardedPoints points;
  GuardedPolygons polygons;
  bool parsed = false;
  try {
    parsed = read_soup(extension, bytes, name, points, polygons);
  } catch (const Error& error) {
    const std::string what = error.what();
    throw Error(error.code(), what.starts_with(name) ? what : name + ": " + what);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::format, name + ": cannot be parsed: " + error.what());
  }
  if (!parsed) throw Error(ErrorCode::format, name + ": " + parse_failure(bytes, extension));
  return triangulated(points, polygons, name);
}

TriangleMesh placed(TriangleMesh mesh, const MeshPlacement& placement) {
  if (!std::isfinite(placement.longest_side) || placement.longest_side < 0) {
    throw Error(ErrorCode::invalid_argument,
                "the longest side must be finite and not negative, not " +
                    short_text(placement.longest_side));
  }
  for (auto& v : mesh.vertices) {
    // Cyclic permutations keep the orientation of the faces.
    if (placement.up == UpAxis::x) v = {v[1], v[2], v[0]};
    if (placement.up == UpAxis::y) v = {v[2], v[0], v[1]};
  }
  if (placement.longest_side > 0) {
    const Bounds bounds = bounds_of(mesh);
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, bounds.max[k] - bounds.min[k]);
    const double scale = placement.longest_side / extent;
    if (!(extent > 0) || !std::isfinite(scale)) {
      throw Error(ErrorCode::invalid_argument, "the mesh has no extent to scale");
    }
    for (auto& v : mesh.vertices) {
      for (double& x : v) x *= scale;
    }
  }
  if (placement.center && !mesh.vertices.empty()) {
    const Bounds bounds = bounds_of(mesh);
    for (auto& v : mesh.vertices) {
      for (std::size_t k = 0; k < 3; ++k) v[k] -= 0.5 * (bounds.min[k] + bounds.max[k]);
    }
  }
  return mesh;
}

}  // namespace viewgain
