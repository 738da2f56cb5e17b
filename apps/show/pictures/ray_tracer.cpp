// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/pictures/ray_tracer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "show/pictures/veils.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

constexpr int kSamplesPerSide = 2;    // of a pixel at an edge
constexpr int kEdgeSkyRays = 4;       // of each sample there
constexpr int kSmoothSkyRays = 10;    // of the one sample of any other pixel
constexpr double kAmbient = 0.62;     // share of the sky's light, the sun has the rest
constexpr double kOffset = 1.5e-4;    // of the occlusion range: a ray must not hit its own start
constexpr std::size_t kAtOnce = 128;  // pixels

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
  void intersect(std::span<const SurfaceScene::Ray> rays,
                 std::vector<SurfaceScene::Hit>& hits) const {
    hits.assign(rays.size(), {});
    if (scene) scene->intersect(rays, hits);
  }

  const PaintedMesh::Part& part;
  std::optional<SurfaceScene> scene;
};

// Traces and shades many places of the picture together, which is what Embree is fast at.
class Renderer {
 public:
  Renderer(const PaintedMesh& painted, const PinholeCamera& camera, const Pose& T_world_camera,
           double occlusion_range, const ExecConfig& exec)
      : painted_(painted),
        solid_(painted.solid(), exec),
        overlay_(painted.overlay(), exec),
        veils_(painted, camera, T_world_camera),
        eye_(T_world_camera.translation()),
        // It stands over the viewer's left shoulder.
        to_sun_((T_world_camera.rotation() * Vector3d(-0.45, -0.75, -0.6)).normalized()),
        occlusion_range_(occlusion_range) {}

  // A place in the picture, in pixel (u, v); `height` in [0, 1] runs down it.
  struct Look {
    Vector3d direction;
    double height;
    std::size_t u, v;
  };

  // What a ray meets. The light of the sky, which takes most rays, is left to colors().
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

  void sample(std::span<const Look> looks, std::span<Sample> samples) const {
    std::vector<SurfaceScene::Ray> rays;
    for (const Look& look : looks) rays.push_back({eye_, look.direction});
    std::vector<SurfaceScene::Hit> solid, overlay;
    solid_.intersect(rays, solid);
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i].max_range = solid[i].range;
    overlay_.intersect(rays, overlay);
    std::vector<Veils::Layer> waiting;
    for (std::size_t i = 0; i < looks.size(); ++i) {
      const Look& look = looks[i];
      Sample& found = samples[i];
      const bool is_overlay = std::isfinite(overlay[i].range);
      const SurfaceScene::Hit& behind = is_overlay ? overlay[i] : solid[i];
      veils_.draw(look.u, look.v, look.direction, behind.range, found.flat, found.visible, waiting);
      if (found.visible == 0) continue;
      if (std::isfinite(behind.range)) {
        meet((is_overlay ? overlay_ : solid_).part, look.direction, behind, found);
      } else {
        found.flat += found.visible * background(look.height);
        found.visible = 0;
      }
    }
    shine(samples);
  }

  // Samples to shade, each by so many rays to the sky; `seed` is unique to the sample.
  struct Shade {
    const Sample* sample;
    int sky_rays;
    std::uint64_t seed;
  };

  [[nodiscard]] std::vector<Vector3d> colors(const std::vector<Shade>& shades) const {
    std::vector<SurfaceScene::Ray> rays;
    for (const Shade& shade : shades) {
      if (shade.sample->visible > 0) add_sky_rays(shade, rays);
    }
    const std::unique_ptr<bool[]> hidden = blocked(rays);
    std::vector<Vector3d> colors;
    std::size_t ray = 0;
    for (const auto& [sample, sky_rays, seed] : shades) {
      colors.push_back(sample->flat);
      if (!(sample->visible > 0)) continue;
      const auto open = std::count(&hidden[ray], &hidden[ray] + sky_rays, false);
      ray += static_cast<std::size_t>(sky_rays);
      const Paint& paint = painted_.paint_of(*sample->part, sample->triangle);
      const double light =
          kAmbient * static_cast<double>(open) / sky_rays + (1 - kAmbient) * 1.5 * sample->sun;
      colors.back() +=
          sample->visible * (sample->front ? 1 : paint.back_side) * light * paint.color;
    }
    return colors;
  }

  // Whether two neighbours show so much the same that no edge lies between them.
  [[nodiscard]] bool is_smooth(const Sample& a, const Sample& b) const {
    constexpr double kSameColor = 0.06, kSameSide = 0.8, kSameRange = 0.03, kSameSun = 0.1;
    if (!((a.flat - b.flat).cwiseAbs().maxCoeff() < kSameColor)) return false;
    if (!(std::abs(a.visible - b.visible) < kSameColor)) return false;
    if (a.visible == 0 && b.visible == 0) return true;
    return a.part == b.part && a.front == b.front &&
           a.part->paint_of_triangle[a.triangle] == b.part->paint_of_triangle[b.triangle] &&
           a.smooth.dot(b.smooth) > kSameSide && std::abs(a.sun - b.sun) < kSameSun &&
           std::abs(a.range - b.range) < kSameRange * std::min(a.range, b.range);
  }

 private:
  static Vector3d background(double height) {
    const Vector3d top(0.80, 0.86, 0.93), bottom(0.97, 0.97, 0.97);
    return top + height * (bottom - top);
  }

  void meet(const PaintedMesh::Part& part, const Vector3d& direction, const SurfaceScene::Hit& hit,
            Sample& found) const {
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
    const Vector3d on_surface = eye_ + hit.range * direction;
    found.smooth = part.shading_normal(hit.triangle, on_surface, normal);
    found.point = on_surface + kOffset * occlusion_range_ * normal;
  }

  // The sun on samples that are lit and turned to it.
  void shine(std::span<Sample> samples) const {
    std::vector<Sample*> lit;
    std::vector<SurfaceScene::Ray> rays;
    for (Sample& sample : samples) {
      if (!(sample.visible > 0 && sample.smooth.dot(to_sun_) > 0)) continue;
      lit.push_back(&sample);
      rays.push_back({sample.point, to_sun_});
    }
    const std::unique_ptr<bool[]> shadow = blocked(rays);
    for (std::size_t i = 0; i < lit.size(); ++i) {
      if (!shadow[i]) lit[i]->sun = lit[i]->smooth.dot(to_sun_);
    }
  }

  [[nodiscard]] std::unique_ptr<bool[]> blocked(const std::vector<SurfaceScene::Ray>& rays) const {
    auto blocked = std::make_unique<bool[]>(rays.size());
    if (solid_.scene) solid_.scene->block(rays, {blocked.get(), rays.size()});
    return blocked;
  }

  // Cosine-weighted, stratified in azimuth.
  void add_sky_rays(const Shade& shade, std::vector<SurfaceScene::Ray>& rays) const {
    const Vector3d& normal = shade.sample->smooth;
    const auto [u, v] = tangents(normal);
    for (int i = 0; i < shade.sky_rays; ++i) {
      const std::uint64_t ray = shade.seed * kSmoothSkyRays + static_cast<std::uint64_t>(i);
      const double azimuth = 2 * std::numbers::pi * (i + random_unit(2 * ray)) / shade.sky_rays;
      const double r2 = random_unit(2 * ray + 1);
      const double r = std::sqrt(r2);
      const Vector3d direction =
          r * std::cos(azimuth) * u + r * std::sin(azimuth) * v + std::sqrt(1 - r2) * normal;
      rays.push_back({shade.sample->point, direction.normalized(), occlusion_range_});
    }
  }

  const PaintedMesh& painted_;
  TracedPart solid_, overlay_;
  Veils veils_;
  Vector3d eye_, to_sun_;
  double occlusion_range_;
};

std::uint8_t encoded(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(255 * std::pow(x, 1 / 2.2)));
}

}  // namespace

RgbImage render(const PaintedMesh& scene, const PinholeCamera& camera, const Pose& T_world_camera,
                double occlusion_range, const ExecConfig& exec) {
  const Eigen::Matrix3d R_world_camera = T_world_camera.rotation();
  const Renderer renderer(scene, camera, T_world_camera, occlusion_range, exec);

  RgbImage image{camera.width, camera.height, {}};
  const auto columns = static_cast<std::size_t>(camera.width);
  const auto rows = static_cast<std::size_t>(camera.height);
  image.pixels.resize(3 * columns * rows);
  const auto look = [&](std::size_t pixel, double du, double dv) -> Renderer::Look {
    const std::size_t u = pixel % columns, v = pixel / columns;
    const double x = static_cast<double>(u), y = static_cast<double>(v);
    return {(R_world_camera * camera.ray(x + du, y + dv)).normalized(),
            y / static_cast<double>(rows), u, v};
  };
  // One ray a pixel tells where the edges are; only there are more needed. In bands of rows, since
  // what a ray meets takes a hundred bytes; each band has a row of its neighbours on either side.
  constexpr std::size_t kBand = 128;
  constexpr int kSamples = kSamplesPerSide * kSamplesPerSide;
  std::vector<Renderer::Sample> centers;
  ThreadPool pool(exec.num_threads);
  for (std::size_t first = 0; first < rows; first += kBand) {
    const std::size_t last = std::min(first + kBand, rows);
    const std::size_t top = first == 0 ? 0 : first - 1, bottom = std::min(last + 1, rows);
    centers.assign((bottom - top) * columns, {});
    pool.for_each_chunk(centers.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
      std::vector<Renderer::Look> looks;
      for (std::size_t i = begin; i < end; ++i) looks.push_back(look(top * columns + i, 0, 0));
      renderer.sample(looks, std::span(centers).subspan(begin, end - begin));
    });
    const auto is_smooth = [&](std::size_t pixel) {
      const std::size_t u = pixel % columns, v = pixel / columns;
      const Renderer::Sample* here = &centers[pixel - top * columns];
      return (u == 0 || renderer.is_smooth(*here, here[-1])) &&
             (v == 0 || renderer.is_smooth(*here, *(here - columns))) &&
             (u + 1 == columns || renderer.is_smooth(*here, here[1])) &&
             (v + 1 == rows || renderer.is_smooth(*here, here[columns]));
    };
    pool.for_each_chunk((last - first) * columns, kAtOnce, [&](std::size_t begin, std::size_t end) {
      const std::size_t offset = first * columns + begin;
      std::vector<std::size_t> edges;
      std::vector<Renderer::Look> looks;
      std::vector<Renderer::Shade> shades;  // whose seeds count the samples of all pixels
      for (std::size_t i = offset; i < offset + end - begin; ++i) {
        if (is_smooth(i)) {
          shades.push_back({&centers[i - top * columns], kSmoothSkyRays, kSamples * i});
          continue;
        }
        edges.push_back(i);
        for (int s = 0; s < kSamples; ++s) {
          looks.push_back(look(i, (s % kSamplesPerSide + 0.5) / kSamplesPerSide - 0.5,
                               (s / kSamplesPerSide + 0.5) / kSamplesPerSide - 0.5));
        }
      }
      std::vector<Renderer::Sample> samples(looks.size());
      renderer.sample(looks, samples);
      const std::size_t smooth = shades.size();
      for (std::size_t k = 0; k < samples.size(); ++k) {
        shades.push_back(
            {&samples[k], kEdgeSkyRays, kSamples * edges[k / kSamples] + k % kSamples});
      }
      const std::vector<Vector3d> colors = renderer.colors(shades);
      std::vector<Vector3d> pixels(end - begin, Vector3d::Zero());
      for (std::size_t k = 0; k < shades.size(); ++k) {
        pixels[shades[k].seed / kSamples - offset] += colors[k] / (k < smooth ? 1 : kSamples);
      }
      for (std::size_t i = 0; i < 3 * pixels.size(); ++i) {
        image.pixels[3 * offset + i] = encoded(pixels[i / 3][static_cast<Eigen::Index>(i % 3)]);
      }
    });
  }
  return image;
}

}  // namespace viewgain::app
