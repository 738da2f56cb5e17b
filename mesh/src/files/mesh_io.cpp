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
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "mesh_builder.hpp"
#include "mesh_file_checks.hpp"
#include "ply_mesh.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

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

// What CGAL reads.
TriangleMesh soup_mesh(const std::string& extension, const std::string& bytes,
                       const std::string& name) {
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
  detail::MeshBuilder mesh(name, points.size());
  for (const Point& p : points) mesh.add_vertex({p.x(), p.y(), p.z()});
  for (const Polygon& polygon : polygons) mesh.add_face(polygon);
  return std::move(mesh).finish();
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
  std::string bytes = file_bytes(path);
  // Some editors put a byte order mark before text; no format of ours begins with one.
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  if (bytes.empty()) throw Error(ErrorCode::format, name + ": the file is empty");
  return extension == ".ply" ? detail::ply_mesh(bytes, name) : soup_mesh(extension, bytes, name);
}

TriangleMesh read_mesh(const std::filesystem::path& path, const MeshPlacement& placement) {
  TriangleMesh mesh = read_mesh(path);
  try {
    return placed(std::move(mesh), placement);
  } catch (const Error& error) {
    throw Error(error.code(), path.string() + ": " + error.what());
  }
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
