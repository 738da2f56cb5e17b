// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/ray_tracer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>

#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kSide = 2, kSamples = kSide * kSide;  // of a pixel
constexpr std::size_t kSkyRays = 3;                         // of each sample
constexpr double kAmbient = 0.62;    // share of the sky's light, the sun has the rest
constexpr double kOffset = 1.5e-4;   // of the occlusion range: a ray must not hit its own start
constexpr std::size_t kAtOnce = 64;  // pixels

// A part of the picture and what finds its triangles; nothing if it is empty.
struct TracedPart {
  TracedPart(const PaintedMesh::Part& painted, const ExecConfig& exec) : part(painted) {
    if (!painted.mesh.triangles.empty()) scene.emplace(painted.mesh, exec);
  }
  void intersect(std::span<const SurfaceScene::Ray> rays,
                 std::vector<SurfaceScene::Hit>& hits) const {
    hits.assign(rays.size(), {});
    if (scene) scene->intersect(rays, hits);
  }
  [[nodiscard]] std::unique_ptr<bool[]> blocked(const std::vector<SurfaceScene::Ray>& rays) const {
    auto blocked = std::make_unique<bool[]>(rays.size());
    if (scene) scene->block(rays, {blocked.get(), rays.size()});
    return blocked;
  }

  const PaintedMesh::Part& part;
  std::optional<SurfaceScene> scene;
};

// Traces and shades many places of the picture together, which is what Embree is fast at.
class Renderer {
 public:
  Renderer(const PaintedMesh& painted, const Pose& T_world_camera, double occlusion_range,
           const ExecConfig& exec)
      : painted_(painted),
        solid_(painted.solid(), exec),
        overlay_(painted.overlay(), exec),
        eye_(T_world_camera.translation()),
        // It stands over the viewer's left shoulder.
        to_sun_((T_world_camera.rotation() * Vector3d(-0.45, -0.75, -0.6)).normalized()),
        occlusion_range_(occlusion_range) {}

  // A place in the picture; `height` in [0, 1] runs down it.
  struct Look {
    Vector3d direction;
    double height;
  };

  // `first`: number of the first among all samples of the picture.
  [[nodiscard]] std::vector<Vector3d> colors(const std::vector<Look>& looks,
                                             std::uint64_t first) const {
    std::vector<SurfaceScene::Ray> rays;
    for (const Look& look : looks) rays.push_back({eye_, look.direction});
    std::vector<SurfaceScene::Hit> solid, overlay;
    solid_.intersect(rays, solid);
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i].max_range = solid[i].range;
    overlay_.intersect(rays, overlay);
    std::vector<Vector3d> colors;
    std::vector<Lit> lit;
    rays.clear();
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const bool is_overlay = std::isfinite(overlay[i].range);
      const SurfaceScene::Hit& hit = is_overlay ? overlay[i] : solid[i];
      const PaintedMesh::Part& part = (is_overlay ? overlay_ : solid_).part;
      if (!std::isfinite(hit.range)) {
        colors.push_back(background(looks[i].height));
        continue;
      }
      const Paint& paint = painted_.paint_of(part, hit.triangle);
      colors.push_back(paint.color);
      if (!paint.lit) continue;
      const bool is_front = hit.normal.dot(looks[i].direction) < 0;
      if (!is_front) colors.back() *= paint.back_side;
      const Vector3d normal = is_front ? hit.normal : Vector3d(-hit.normal);
      const Vector3d on_surface = eye_ + hit.range * looks[i].direction;
      lit.push_back({i, part.shading_normal(hit.triangle, on_surface, normal)});
      const Vector3d from = on_surface + kOffset * occlusion_range_ * normal;
      rays.push_back({from, to_sun_});
      add_sky_rays(from, lit.back().normal, first + i, rays);
    }
    const std::unique_ptr<bool[]> blocked = solid_.blocked(rays);
    const bool* ray = blocked.get();
    for (const auto& [i, normal] : lit) {
      const double sun = *ray++ ? 0 : std::max(0.0, normal.dot(to_sun_));
      const auto open = static_cast<double>(std::count(ray, ray + kSkyRays, false));
      ray += kSkyRays;
      colors[i] *= kAmbient * open / kSkyRays + (1 - kAmbient) * 1.5 * sun;
    }
    return colors;
  }

 private:
  struct Lit {
    std::size_t sample;
    Vector3d normal;
  };

  static Vector3d background(double height) {
    const Vector3d top(0.80, 0.86, 0.93), bottom(0.97, 0.97, 0.97);
    return top + height * (bottom - top);
  }

  // Cosine-weighted, stratified in azimuth over all samples of a pixel.
  void add_sky_rays(const Vector3d& from, const Vector3d& normal, std::uint64_t sample,
                    std::vector<SurfaceScene::Ray>& rays) const {
    constexpr std::size_t kRays = kSkyRays * kSamples;
    const auto [u, v] = tangents(normal);
    for (std::size_t i = 0; i < kSkyRays; ++i) {
      const std::uint64_t ray = sample * kSkyRays + i;
      const auto place = static_cast<double>(i * kSamples + sample % kSamples);
      const double azimuth = 2 * std::numbers::pi * (place + unit_number(mix64(2 * ray))) / kRays;
      const double r2 = unit_number(mix64(2 * ray + 1)), r = std::sqrt(r2);
      const Vector3d direction =
          r * std::cos(azimuth) * u + r * std::sin(azimuth) * v + std::sqrt(1 - r2) * normal;
      rays.push_back({from, direction.normalized(), occlusion_range_});
    }
  }

  const PaintedMesh& painted_;
  TracedPart solid_, overlay_;
  Vector3d eye_, to_sun_;
  double occlusion_range_;
};

std::uint8_t encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(255 * std::pow(x, 1 / 2.2)));
}

}  // namespace

using Eigen::Vector3d;

std::pair<Vector3d, Vector3d> tangents(const Vector3d& n) {
  const Vector3d helper = std::abs(n.z()) < 0.9 ? Vector3d::UnitZ() : Vector3d::UnitX();
  const Vector3d u = n.cross(helper).normalized();
  return {u, n.cross(u)};
}

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

RgbImage render(const PaintedMesh& scene, const PinholeCamera& camera, const Pose& T_world_camera,
                double occlusion_range, const ExecConfig& exec) {
  const Eigen::Matrix3d R_world_camera = T_world_camera.rotation();
  const Renderer renderer(scene, T_world_camera, occlusion_range, exec);
  RgbImage image{camera.width, camera.height, {}};
  const auto columns = static_cast<std::size_t>(camera.width);
  const auto rows = static_cast<std::size_t>(camera.height);
  image.pixels.resize(3 * columns * rows);
  const auto draw = [&](std::size_t begin, std::size_t end) {
    std::vector<Renderer::Look> looks;
    for (std::size_t sample = kSamples * begin; sample < kSamples * end; ++sample) {
      const std::size_t pixel = sample / kSamples;
      const auto place = [](std::size_t whole, std::size_t part) {
        return static_cast<double>(whole) + (static_cast<double>(part) + 0.5) / kSide - 0.5;
      };
      const double v = place(pixel / columns, sample % kSamples / kSide);
      const Vector3d ray = camera.ray(place(pixel % columns, sample % kSide), v);
      looks.push_back({(R_world_camera * ray).normalized(), v / static_cast<double>(rows)});
    }
    const std::vector<Vector3d> colors = renderer.colors(looks, kSamples * begin);
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      Vector3d mean = Vector3d::Zero();
      for (std::size_t s = 0; s < kSamples; ++s) {
        mean += colors[kSamples * (pixel - begin) + s] / kSamples;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        image.pixels[3 * pixel + c] = encoded(mean[static_cast<Eigen::Index>(c)]);
      }
    }
  };
  ThreadPool(exec.num_threads).for_each_chunk(columns * rows, kAtOnce, draw);
  return image;
}

}  // namespace viewgain::app
