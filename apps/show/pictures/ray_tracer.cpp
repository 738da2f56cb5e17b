// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/ray_tracer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "viewgain/core/thread_pool.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

constexpr int kSamplesPerSide = 2;  // of a pixel at an edge
constexpr int kEdgeSkyRays = 4;     // of each sample there
constexpr int kSmoothSkyRays = 10;  // of the one sample of any other pixel
constexpr double kAmbient = 0.62;   // share of the sky's light, the sun has the rest
constexpr double kHidden = 0.02;    // less visible than this is not looked at any more
constexpr double kOffset = 1.5e-4;  // of the occlusion range: a ray must not hit its own start

// Two directions that make a right-handed frame with the unit vector n.
std::pair<Vector3d, Vector3d> tangents(const Vector3d& n) {
  const Vector3d helper = std::abs(n.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d u = n.cross(helper).normalized();
  return {u, n.cross(u)};
}

// A well mixed number in [0, 1) for an integer, so that the picture does not depend on who renders.
double random_unit(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<double>((x ^ (x >> 31U)) >> 11U) * 0x1.0p-53;
}

// A part of the picture and what finds its triangles; nothing if it is empty.
struct TracedPart {
  TracedPart(const PaintedMesh::Part& painted, const ExecConfig& exec) : part(painted) {
    if (!painted.mesh.triangles.empty()) scene.emplace(painted.mesh, exec);
  }
  [[nodiscard]] SurfaceHit intersect(const Vector3d& origin, const Vector3d& direction,
                                     double range) const {
    return scene ? scene->intersect(origin, direction, range) : SurfaceHit{};
  }

  const PaintedMesh::Part& part;
  std::optional<SurfaceScene> scene;
};

class Renderer {
 public:
  Renderer(const PaintedMesh& painted, const Vector3d& to_sun, double occlusion_range,
           const ExecConfig& exec)
      : painted_(painted),
        solid_(painted.solid(), exec),
        overlay_(painted.overlay(), exec),
        to_sun_(to_sun),
        occlusion_range_(occlusion_range) {}

  // What a ray meets. The light of the sky, which takes most rays, is left to color().
  struct Sample {
    Vector3d flat = Vector3d::Zero();  // what is drawn flat, in front of the rest
    double visible = 1;                // share of what is lit behind it; 0: there is nothing
    double range = 0;
    const PaintedMesh::Part* part = nullptr;
    std::uint32_t triangle = 0;
    bool front = true;
    Vector3d smooth = Vector3d::Zero(), point = smooth;  // of the lit surface
    double sun = 0;
  };

  // `height` in [0, 1] runs down the picture.
  [[nodiscard]] Sample sample(const Vector3d& eye, const Vector3d& direction, double height) const {
    const SurfaceHit behind = solid_.intersect(eye, direction, kFar);
    Sample found;
    for (double start = 0; start < behind.range;) {
      const Vector3d origin = eye + start * direction;
      const SurfaceHit hit = overlay_.intersect(origin, direction, behind.range - start);
      if (!std::isfinite(hit.range)) break;
      const Paint& paint = painted_.paint_of(overlay_.part, hit.triangle);
      if (paint.lit || paint.opacity >= 1 || found.visible < kHidden) {
        meet(overlay_.part, origin, direction, hit, found);
        found.range += start;
        return found;
      }
      found.flat += found.visible * paint.opacity * paint.color;
      found.visible *= 1 - paint.opacity;
      start += hit.range + kOffset * occlusion_range_;
    }
    if (std::isfinite(behind.range)) {
      meet(solid_.part, eye, direction, behind, found);
    } else {
      found.flat += found.visible * background(height);
      found.visible = 0;
    }
    return found;
  }

  // `seed` is unique to the sample.
  [[nodiscard]] Vector3d color(const Sample& found, int sky_rays, std::uint64_t seed) const {
    if (!(found.visible > 0)) return found.flat;
    const Paint& paint = painted_.paint_of(*found.part, found.triangle);
    const double light = kAmbient * open_sky(found.point, found.smooth, sky_rays, seed) +
                         (1 - kAmbient) * 1.5 * found.sun;
    return found.flat + found.visible * (found.front ? 1 : paint.back_side) * light * paint.color;
  }

  // Whether two neighbours show so much the same that no edge lies between them.
  [[nodiscard]] bool is_smooth(const Sample& a, const Sample& b) const {
    constexpr double kSameColor = 0.04, kSameSide = 0.8, kSameRange = 0.03, kSameSun = 0.1;
    if (!((a.flat - b.flat).cwiseAbs().maxCoeff() < kSameColor)) return false;
    if (!(std::abs(a.visible - b.visible) < kSameColor)) return false;
    if (a.visible == 0 && b.visible == 0) return true;
    return a.part == b.part && a.front == b.front &&
           a.part->paint_of_triangle[a.triangle] == b.part->paint_of_triangle[b.triangle] &&
           a.smooth.dot(b.smooth) > kSameSide && std::abs(a.sun - b.sun) < kSameSun &&
           std::abs(a.range - b.range) < kSameRange * std::min(a.range, b.range);
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  static Vector3d background(double height) {
    const Vector3d top(0.80, 0.86, 0.93), bottom(0.97, 0.97, 0.97);
    return top + height * (bottom - top);
  }

  void meet(const PaintedMesh::Part& part, const Vector3d& eye, const Vector3d& direction,
            const SurfaceHit& hit, Sample& found) const {
    const Paint& paint = painted_.paint_of(part, hit.triangle);
    if (!paint.lit) {
      found.flat += found.visible * paint.color;
      found.visible = 0;
      return;
    }
    found.part = &part;
    found.triangle = hit.triangle;
    found.range = hit.range;
    found.front = hit.normal.dot(direction) < 0;
    const Vector3d normal = found.front ? hit.normal : Vector3d(-hit.normal);
    const Vector3d on_surface = eye + hit.range * direction;
    found.smooth = part.shading_normal(hit.triangle, on_surface, normal);
    found.point = on_surface + kOffset * occlusion_range_ * normal;
    const double facing = std::max(0.0, found.smooth.dot(to_sun_));
    found.sun = facing > 0 && !blocked(found.point, to_sun_, kFar) ? facing : 0.0;
  }

  [[nodiscard]] bool blocked(const Vector3d& from, const Vector3d& direction, double range) const {
    const SurfaceHit hit = solid_.intersect(from, direction, range);
    return std::isfinite(hit.range) && painted_.paint_of(solid_.part, hit.triangle).lit;
  }

  // Share of the sky that the point sees, cosine-weighted, stratified in azimuth.
  [[nodiscard]] double open_sky(const Vector3d& point, const Vector3d& normal, int rays,
                                std::uint64_t seed) const {
    const auto [u, v] = tangents(normal);
    int open = 0;
    for (int i = 0; i < rays; ++i) {
      const std::uint64_t ray = seed * kSmoothSkyRays + static_cast<std::uint64_t>(i);
      const double azimuth = 2 * std::numbers::pi * (i + random_unit(2 * ray)) / rays;
      const double r2 = random_unit(2 * ray + 1);
      const double r = std::sqrt(r2);
      const Vector3d direction =
          r * std::cos(azimuth) * u + r * std::sin(azimuth) * v + std::sqrt(1 - r2) * normal;
      open += blocked(point, direction.normalized(), occlusion_range_) ? 0 : 1;
    }
    return static_cast<double>(open) / rays;
  }

  const PaintedMesh& painted_;
  TracedPart solid_, overlay_;
  Vector3d to_sun_;
  double occlusion_range_;
};

std::uint8_t encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(255 * std::pow(x, 1 / 2.2)));
}

}  // namespace

std::uint8_t PaintedMesh::add_paint(const Paint& paint) {
  paints_.push_back(paint);
  return static_cast<std::uint8_t>(paints_.size() - 1);
}

void PaintedMesh::add_hexahedron(const std::array<Vector3d, 8>& corners, std::uint8_t paint) {
  Part& part = part_for(paint);
  const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
  for (const Vector3d& p : corners) part.mesh.vertices.push_back({p.x(), p.y(), p.z()});
  for (const auto& t : kBoxTriangles) {
    part.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    part.paint_of_triangle.push_back(paint);
  }
}

void PaintedMesh::add_surface(const std::vector<std::array<double, 3>>& vertices,
                              const std::vector<std::array<double, 3>>& normals,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              std::uint8_t paint) {
  add_surface(vertices, normals, triangles, std::vector(triangles.size(), paint));
}

void PaintedMesh::add_surface(const std::vector<std::array<double, 3>>& vertices,
                              const std::vector<std::array<double, 3>>& normals,
                              const std::vector<std::array<std::uint32_t, 3>>& triangles,
                              const std::vector<std::uint8_t>& paint_of_triangle) {
  if (triangles.empty()) return;
  Part& part = part_for(paint_of_triangle.front());
  const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
  part.mesh.vertices.insert(part.mesh.vertices.end(), vertices.begin(), vertices.end());
  part.normals.resize(first, Vector3d::Zero());
  for (const auto& n : normals) part.normals.emplace_back(n[0], n[1], n[2]);
  for (const auto& t : triangles) {
    part.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  part.paint_of_triangle.insert(part.paint_of_triangle.end(), paint_of_triangle.begin(),
                                paint_of_triangle.end());
}

void PaintedMesh::add_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                               std::uint8_t paint) {
  Part& part = part_for(paint);
  const auto first = static_cast<std::uint32_t>(part.mesh.vertices.size());
  for (const Vector3d& p : {a, b, c}) part.mesh.vertices.push_back({p.x(), p.y(), p.z()});
  part.mesh.triangles.push_back({first, first + 1, first + 2});
  part.paint_of_triangle.push_back(paint);
}

Vector3d PaintedMesh::Part::shading_normal(std::uint32_t triangle, const Vector3d& point,
                                           const Vector3d& normal) const {
  const auto& t = mesh.triangles[triangle];
  if (std::max({t[0], t[1], t[2]}) >= normals.size()) return normal;
  const auto vertex = [&](std::size_t k) {
    return Eigen::Map<const Vector3d>(mesh.vertices[t[k]].data());
  };
  // Each corner's share is the area of the triangle between the point and the opposite edge.
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d a = vertex((k + 1) % 3) - point, b = vertex((k + 2) % 3) - point;
    sum += a.cross(b).norm() * normals[t[k]];
  }
  if (!(sum.norm() > 0)) return normal;
  return sum.dot(normal) < 0 ? Vector3d(-sum.normalized()) : Vector3d(sum.normalized());
}

void PaintedMesh::add_line(const Vector3d& a, const Vector3d& b, double width, std::uint8_t paint) {
  const auto [u, v] = tangents((b - a).normalized());
  std::array<Vector3d, 8> corners;
  for (unsigned k = 0; k < 8; ++k) {
    corners[k] = ((k & 4U) != 0 ? b : a) + ((k & 1U) != 0 ? 0.5 : -0.5) * width * u +
                 ((k & 2U) != 0 ? 0.5 : -0.5) * width * v;
  }
  add_hexahedron(corners, paint);
}

void PaintedMesh::add_ribbon(const Vector3d& a, const Vector3d& b, double width,
                             const Vector3d& viewer_eye, std::uint8_t paint) {
  // In pieces: the box round a long slanting triangle is large and empty, which slows every ray.
  constexpr int kPieces = 48;
  const Vector3d half = 0.5 * width * (b - a).cross(a - viewer_eye).normalized();
  for (int i = 0; i < kPieces; ++i) {
    const Vector3d begin = a + i * (b - a) / kPieces, end = a + (i + 1) * (b - a) / kPieces;
    add_triangle(begin - half, begin + half, end - half, paint);
    add_triangle(end - half, begin + half, end + half, paint);
  }
}

RgbImage render(const PaintedMesh& scene, const PinholeCamera& camera, const Pose& T_world_camera,
                double occlusion_range, const ExecConfig& exec) {
  const Eigen::Matrix3d R_world_camera = T_world_camera.rotation();
  const Vector3d eye = T_world_camera.translation();
  // The sun stands over the viewer's left shoulder.
  const Vector3d to_sun = (R_world_camera * Vector3d(-0.45, -0.75, -0.6)).normalized();
  const Renderer renderer(scene, to_sun, occlusion_range, exec);

  RgbImage image{camera.width, camera.height, {}};
  const auto columns = static_cast<std::size_t>(camera.width);
  const auto rows = static_cast<std::size_t>(camera.height);
  image.pixels.resize(3 * columns * rows);
  const auto sample = [&](std::size_t u, std::size_t v, double du, double dv) {
    const Vector3d ray = camera.ray(static_cast<double>(u) + du, static_cast<double>(v) + dv);
    return renderer.sample(eye, (R_world_camera * ray).normalized(),
                           static_cast<double>(v) / static_cast<double>(rows));
  };
  // One ray a pixel tells where the edges are; only there are more needed. In bands of rows, since
  // what a ray meets takes a hundred bytes; each band has a row of its neighbours on either side.
  constexpr std::size_t kBand = 128;
  constexpr int kSamples = kSamplesPerSide * kSamplesPerSide;
  std::vector<Renderer::Sample> centers((kBand + 2) * columns);
  ThreadPool pool(exec.num_threads);
  for (std::size_t first = 0; first < rows; first += kBand) {
    const std::size_t last = std::min(first + kBand, rows);
    const std::size_t top = first == 0 ? 0 : first - 1, bottom = std::min(last + 1, rows);
    pool.for_each_chunk(bottom - top, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin * columns; i < end * columns; ++i) {
        centers[i] = sample(i % columns, top + i / columns, 0, 0);
      }
    });
    const auto is_smooth = [&](std::size_t u, std::size_t v) {
      const Renderer::Sample* here = &centers[(v - top) * columns + u];
      return (u == 0 || renderer.is_smooth(*here, here[-1])) &&
             (v == 0 || renderer.is_smooth(*here, *(here - columns))) &&
             (u + 1 == columns || renderer.is_smooth(*here, here[1])) &&
             (v + 1 == rows || renderer.is_smooth(*here, here[columns]));
    };
    pool.for_each_chunk(last - first, 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = (first + begin) * columns; i < (first + end) * columns; ++i) {
        const std::size_t u = i % columns, v = i / columns;
        Vector3d sum = Vector3d::Zero();
        if (is_smooth(u, v)) {
          sum = renderer.color(centers[i - top * columns], kSmoothSkyRays, kSamples * i);
        } else {
          for (int s = 0; s < kSamples; ++s) {
            const double du = (s % kSamplesPerSide + 0.5) / kSamplesPerSide - 0.5;
            const double dv = (s / kSamplesPerSide + 0.5) / kSamplesPerSide - 0.5;
            sum += renderer.color(sample(u, v, du, dv), kEdgeSkyRays,
                                  kSamples * i + static_cast<std::size_t>(s));
          }
          sum /= kSamples;
        }
        for (std::size_t k = 0; k < 3; ++k) {
          image.pixels[3 * i + k] = encoded(sum[static_cast<Eigen::Index>(k)]);
        }
      }
    });
  }
  return image;
}

}  // namespace viewgain::app
