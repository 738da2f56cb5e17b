// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "integrate_bench.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "environment.hpp"
#include "measure.hpp"
#include "methods/octomap_integrate.hpp"
#include "oracle/walk.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;
using test::CamelView;

constexpr double kTolerance = 1e-4;  ///< [voxel]

/// The ray of a pixel up to its reading, in voxels of the grid's frame.
struct PixelRay {
  oracle::Ray ray;
  double reach = 0;  ///< [voxel]
  bool is_reading = false;
};

std::vector<PixelRay> pixel_rays(const Sensor& sensor, const CamelView& view, double voxel_size) {
  const std::vector<Eigen::Vector3d> table = sensor.camera.ray_table();
  std::vector<PixelRay> rays;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double range = static_cast<double>(view.frame.depth[i]) * table[i].norm();
    if (!(range >= sensor.min_range)) continue;
    rays.push_back({{view.T_world_camera.translation() / voxel_size,
                     view.T_world_camera.rotation() * table[i].normalized()},
                    std::min(range, sensor.max_range) / voxel_size,
                    range <= sensor.max_range});
  }
  return rays;
}

/// How deep inside the voxel the point is: negative outside [voxel].
double depth_inside(Index3 voxel, const Eigen::Vector3d& p) {
  const Eigen::Vector3d q = p - Eigen::Vector3d(voxel.x, voxel.y, voxel.z);
  return std::min(q.minCoeff(), (Eigen::Vector3d::Ones() - q).minCoeff());
}

/// What exact geometry says of a voxel and a frame.
struct Contact {
  bool grazed = false;   ///< a ray or a reading passes within the tolerance of its boundary
  bool crossed = false;  ///< a ray passes through, deeper than the tolerance
  bool hit = false;      ///< a reading lies inside, deeper than the tolerance
};

Contact contact_of(Index3 voxel, const std::vector<PixelRay>& rays) {
  Contact contact;
  for (const PixelRay& pixel : rays) {
    // Rays that pass the voxel's middle at more than its half diagonal cannot touch it.
    const Eigen::Vector3d to_middle =
        Eigen::Vector3d(voxel.x + 0.5, voxel.y + 0.5, voxel.z + 0.5) - pixel.ray.origin;
    const double along = to_middle.dot(pixel.ray.direction);
    if (to_middle.squaredNorm() - along * along > 0.76) continue;
    if (along > pixel.reach + 1) continue;
    double in = 0;
    double out = pixel.reach;
    double in_core = 0;
    double out_core = pixel.reach;
    for (int k = 0; k < 3; ++k) {
      const double low = to_middle[k] - 0.5;
      const double d = pixel.ray.direction[k];
      const double pad = std::abs(d) > 0 ? kTolerance : 0;
      const double a = (low - pad) / d;
      const double b = (low + 1 + pad) / d;
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
      const double c = (low + pad) / d;
      const double e = (low + 1 - pad) / d;
      in_core = std::max(in_core, std::min(c, e));
      out_core = std::min(out_core, std::max(c, e));
    }
    const bool touches = in < out;
    const bool crosses = in_core < out_core;
    contact.crossed = contact.crossed || crosses;
    contact.grazed = contact.grazed || (touches && !crosses);
    if (!pixel.is_reading) continue;
    const double depth = depth_inside(voxel, pixel.ray.origin + pixel.reach * pixel.ray.direction);
    contact.hit = contact.hit || depth > kTolerance;
    contact.grazed = contact.grazed || std::abs(depth) <= kTolerance;
  }
  return contact;
}

/// Voxels in which OctoMap and ours differ, by reason.
struct Comparison {
  std::size_t voxels = 0;
  std::size_t same = 0;
  std::size_t ties = 0;  ///< at a boundary in one of the frames, within 1e-4 voxel
  std::size_t tapers =
      0;  ///< hit in one frame, crossed in another: our misses fade before a reading
  [[nodiscard]] std::size_t unexplained() const { return voxels - same - ties - tapers; }
  [[nodiscard]] double share() const {
    return static_cast<double>(same) / static_cast<double>(voxels);
  }
};

VoxelState state_of(const octomap::OcTree& tree, Index3 voxel) {
  const octomap::OcTreeNode* node = tree.search(key_of(voxel));
  if (node == nullptr) return VoxelState::unknown;
  return node->getLogOdds() > 0 ? VoxelState::occupied : VoxelState::free;
}

Comparison compare(const oracle::DenseMap& ours, const octomap::OcTree& tree, const Sensor& sensor,
                   const std::vector<CamelView>& views) {
  std::vector<std::vector<PixelRay>> rays;
  for (const CamelView& view : views) rays.push_back(pixel_rays(sensor, view, ours.voxel_size));
  Comparison result;
  for (int x = 0; x < ours.dims.x; ++x) {
    for (int y = 0; y < ours.dims.y; ++y) {
      for (int z = 0; z < ours.dims.z; ++z) {
        const Index3 voxel{ours.min_index.x + x, ours.min_index.y + y, ours.min_index.z + z};
        ++result.voxels;
        if (ours.state(voxel) == state_of(tree, voxel)) {
          ++result.same;
          continue;
        }
        bool grazed = false;
        bool hit = false;
        int frames = 0;
        for (const std::vector<PixelRay>& frame : rays) {
          const Contact contact = contact_of(voxel, frame);
          grazed = grazed || contact.grazed;
          hit = hit || contact.hit;
          frames += contact.crossed || contact.hit ? 1 : 0;
        }
        if (grazed) {
          ++result.ties;
        } else if (hit && frames > 1) {
          ++result.tapers;
        }
      }
    }
  }
  return result;
}

Json to_json(const Comparison& c) {
  return {{"voxels", c.voxels},
          {"equal", c.share()},
          {"differ_at_boundaries", c.ties},
          {"differ_by_tapered_misses", c.tapers},
          {"unexplained", c.unexplained()}};
}

Json to_json(const std::vector<double>& ms) {
  return {{"median", median(ms)}, {"p05", quantile(ms, 0.05)}, {"p95", quantile(ms, 0.95)}};
}

/// A frame into a copy of the map; copying is not timed.
double time_ours(const BeliefGrid& before, FrameIntegrator& integrator, const CamelView& view) {
  BeliefGrid grid = before.clone();
  return 1e3 * seconds_of([&] { integrator.integrate(grid, view.frame, view.T_world_camera); });
}

/// By lines and by a sensor so sure of its readings that each counts for the voxel that it lies in,
/// as OctoMap has it (grid/README.md).
BeliefGrid literal_hits(int voxels, Sensor sensor, const std::vector<CamelView>& views) {
  sensor.noise = ConstantNoise{1e-4, 1e-3};
  BeliefGrid grid = test::empty_camel_grid(voxels);
  FrameIntegrator integrator(sensor, {.carve = IntegrationConfig::Carve::lines});
  for (const CamelView& view : views) {
    integrator.integrate(grid, view.frame, view.T_world_camera);
  }
  return grid;
}

void print_table(const Json& json) {
  std::printf("one frame into %s, %s\n\n", json["scene"].get<std::string>().c_str(),
              json["cpu"].get<std::string>().c_str());
  std::printf("%-18s %8s %10s %10s %10s\n", "method", "threads", "ms", "p05", "p95");
  for (const auto& [name, ms] : json["milliseconds"].items()) {
    std::printf("%-18s %8d %10.3f %10.3f %10.3f\n", name.c_str(),
                name == "octomap" ? 1 : json["threads"].get<int>(), ms["median"].get<double>(),
                ms["p05"].get<double>(), ms["p95"].get<double>());
  }
  std::printf("\n");
  for (const auto& [name, ratio] : json["ratios"].items()) {
    std::printf("%-26s %8.1f\n", name.c_str(), ratio.get<double>());
  }
  for (const auto& [name, c] : json["agreement"].items()) {
    std::printf(
        "\n"
        "%s, voxels along rays: %.6f of %d voxels have the same state in both maps. %d differ at "
        "voxel boundaries, %d because viewgain lowers the evidence less in front of a measured "
        "point, %d for unknown reasons\n",
        name.c_str(), c["equal"].get<double>(), c["voxels"].get<int>(),
        c["differ_at_boundaries"].get<int>(), c["differ_by_tapered_misses"].get<int>(),
        c["unexplained"].get<int>());
  }
}

}  // namespace

nlohmann::ordered_json measure_integrate(const IntegrateOptions& options) {
  const Sensor sensor = sensor_preset("sr4000");
  const ExecConfig exec{.num_threads = ThreadPool(options.num_threads).num_threads()};
  const std::vector<CamelView> views = test::camel_views(4, options.mesh);
  const std::vector<CamelView> first(views.begin(), views.begin() + 3);
  const CamelView& next = views.back();
  const IntegrationConfig with_lines{.carve = IntegrationConfig::Carve::lines};

  const BeliefGrid cones = test::camel_grid(options.voxels, first);
  const BeliefGrid lines = test::camel_grid(options.voxels, first, with_lines);
  FrameIntegrator cone_integrator(sensor, {}, exec);
  FrameIntegrator line_integrator(sensor, with_lines, exec);
  const oracle::DenseMap workspace(test::empty_camel_grid(options.voxels));
  OctomapIntegrator octomap_integrator(sensor, workspace);
  const auto tree = empty_octree(workspace.voxel_size);

  // One frame alone, then all four: the same job, judged voxel by voxel.
  Json agreement;
  std::size_t unexplained = 0;
  bool agree = true;
  const auto judge = [&](const char* name, const BeliefGrid& grid,
                         const std::vector<CamelView>& of) {
    const Comparison c = compare(oracle::DenseMap(grid), *tree, sensor, of);
    agreement[name] = to_json(c);
    unexplained += c.unexplained();
    agree = agree && c.share() >= 0.999;
  };
  octomap_integrator.integrate(*tree, first[0].frame, first[0].T_world_camera);
  judge("first frame", literal_hits(options.voxels, sensor, {first[0]}), {first[0]});
  octomap_integrator.integrate(*tree, first[1].frame, first[1].T_world_camera);
  octomap_integrator.integrate(*tree, first[2].frame, first[2].T_world_camera);
  octomap::OcTree before(*tree);
  before.prune();
  octomap_integrator.integrate(*tree, next.frame, next.T_world_camera);
  judge("four frames", literal_hits(options.voxels, sensor, views), views);

  std::vector<double> octomap_ms;
  std::vector<double> lines_ms;
  std::vector<double> cones_ms;
  for (int i = -1; i < options.repetitions; ++i) {
    octomap::OcTree copy(before);
    const double of_octomap = 1e3 * seconds_of([&] {
                                octomap_integrator.integrate(copy, next.frame, next.T_world_camera);
                              });
    const double of_lines = time_ours(lines, line_integrator, next);
    const double of_cones = time_ours(cones, cone_integrator, next);
    if (i < 0) continue;  // warming up
    octomap_ms.push_back(of_octomap);
    lines_ms.push_back(of_lines);
    cones_ms.push_back(of_cones);
  }

  Json json;
  json["scene"] = "camel-" + std::to_string(options.voxels);
  add_environment(json, exec.num_threads);
  json["repetitions"] = options.repetitions;
  json["milliseconds"] = {{"octomap", to_json(octomap_ms)},
                          {"viewgain_lines", to_json(lines_ms)},
                          {"viewgain_cones", to_json(cones_ms)}};
  json["ratios"] = {{"octomap/viewgain_lines", median(octomap_ms) / median(lines_ms)},
                    {"octomap/viewgain_cones", median(octomap_ms) / median(cones_ms)}};
  json["agreement"] = agreement;
  json["agree"] = agree && unexplained == 0;
  return json;
}

int run_integrate(const IntegrateOptions& options) {
  const Json json = measure_integrate(options);
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(json);
  }
  return json["agree"].get<bool>() ? 0 : 1;
}

}  // namespace viewgain::bench
