// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "honesty_bench.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "environment.hpp"
#include "measure.hpp"
#include "model_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/mesh/quality.hpp"
#include "viewgain/planner/point_arrays.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kVoxels{0.002, 0.003125, 0.006};  // [m]
constexpr std::array kRepeats{1, 2, 5, 10};
constexpr double kDistance = 0.45;  // of the camera from the object's centre [m]

Consistency consistency_of(const GroundTruth& truth, const std::vector<FusedPoint>& points) {
  const PointArrays arrays = arrays_of(points);
  return truth.consistency(arrays.positions, arrays.covariances);
}

double mean_hits(const std::vector<FusedPoint>& points) {
  double sum = 0;
  for (const FusedPoint& point : points) sum += point.hits;
  return sum / static_cast<double>(points.size());
}

Json row(double voxel, int repeats, const char* rule, const GroundTruth& truth,
         const std::vector<FusedPoint>& points) {
  const Consistency c = consistency_of(truth, points);
  return {{"voxel", voxel},
          {"repeats", repeats},
          {"rule", rule},
          {"readings_per_point", mean_hits(points)},
          {"points", points.size()},
          {"consistency", c.mean_clipped},
          {"consistency_median", c.median},
          {"above_9", c.above_9},
          {"outliers", c.outliers}};
}

Json consistency_rows(const ModelScene& scene, const GroundTruth& truth,
                      const HonestyOptions& options, const ExecConfig& exec) {
  const std::vector<Pose> views = sphere_poses(static_cast<std::size_t>(options.views), kDistance);
  FusedPointsConfig literal;
  literal.per_voxel = true;
  Json rows = Json::array();
  for (const double voxel : kVoxels) {
    BeliefGrid grid = scene.empty_grid(voxel);
    FrameIntegrator integrator(scene.sensor(), {}, exec);
    std::uint64_t frame = 0;
    int done = 0;
    for (const int repeats : kRepeats) {
      for (; done < repeats; ++done) {
        for (const Pose& view : views)
          integrator.integrate(grid, scene.acquire(view, frame++), view);
      }
      rows.push_back(row(voxel, repeats, "pooled", truth, fused_points(grid, {}, exec)));
      rows.push_back(row(voxel, repeats, "per_voxel", truth, fused_points(grid, literal, exec)));
    }
  }
  return rows;
}

// The positions that the view sees: in its image, within 10 mm of the true depth there.
std::vector<std::array<double, 3>> seen_by(const ModelScene& scene, const Pose& T_world_camera,
                                           const std::vector<std::array<double, 3>>& positions) {
  constexpr double kDepthTolerance = 0.01;  // [m]
  const DepthFrame truth = scene.true_frame(T_world_camera);
  const Pose T_camera_world = T_world_camera.inverse();
  std::vector<std::array<double, 3>> seen;
  for (const auto& p : positions) {
    const Eigen::Vector3d q = T_camera_world * Eigen::Vector3d(p[0], p[1], p[2]);
    if (!(q.z() > 0)) continue;
    const Eigen::Vector2d pixel = scene.sensor().camera.project(q);
    const long u = std::lround(pixel.x()), v = std::lround(pixel.y());
    if (u < 0 || v < 0 || u >= truth.width || v >= truth.height) continue;
    const double depth = static_cast<double>(truth.at(static_cast<int>(u), static_cast<int>(v)));
    if (std::abs(depth - q.z()) < kDepthTolerance) seen.push_back(p);
  }
  return seen;
}

Json refinement(const ModelScene& scene, const GroundTruth& truth, const ExecConfig& exec) {
  constexpr double kVoxel = 0.003125;
  constexpr int kViews = 3, kTimes = 4;
  const std::vector<Pose> views =
      orbit_poses(kViews, kDistance, 27 * std::numbers::pi / 180, 0, 0.8);
  BeliefGrid grid = scene.empty_grid(kVoxel);
  FrameIntegrator integrator(scene.sensor(), {}, exec);
  Json json = Json::array();
  std::uint64_t frame = 0;
  for (int repeat = 1; repeat <= kTimes; ++repeat) {
    for (const Pose& view : views) integrator.integrate(grid, scene.acquire(view, frame++), view);
    const std::vector<FusedPoint> points = fused_points(grid, {}, exec);
    const SurfaceMesh surface = surface_of(points, exec);
    json.push_back(
        {{"repeats", repeat},
         {"rms_surface", truth.error(seen_by(scene, views[0], surface.vertices)).rms},
         {"rms_points", truth.error(seen_by(scene, views[0], arrays_of(points).positions)).rms}});
  }
  return json;
}

void print(const Json& json) {
  std::printf("consistency, mean of min(z^2, 25): 1 if honest\n");
  std::printf("%8s %8s %10s %10s %10s %8s %8s %9s\n", "voxel mm", "repeats", "rule", "readings",
              "mean", "median", "above 9", "outliers");
  for (const Json& r : json["consistency"]) {
    std::printf("%8.3f %8d %10s %10.1f %10.2f %8.2f %8.3f %9zu\n", 1e3 * r["voxel"].get<double>(),
                r["repeats"].get<int>(), r["rule"].get<std::string>().c_str(),
                r["readings_per_point"].get<double>(), r["consistency"].get<double>(),
                r["consistency_median"].get<double>(), r["above_9"].get<double>(),
                r["outliers"].get<std::size_t>());
  }
  std::printf("\nthe region of view 1, three views repeated: RMS\n");
  for (const Json& r : json["refinement"]) {
    std::printf("%d x: surface %.3f mm, points %.3f mm\n", r["repeats"].get<int>(),
                1e3 * r["rms_surface"].get<double>(), 1e3 * r["rms_points"].get<double>());
  }
  std::printf("four times against once: surface %.3f, points %.3f\n",
              json["refinement_ratio"].get<double>(),
              json["refinement_ratio_points"].get<double>());
}

}  // namespace

int run_honesty(const HonestyOptions& options) {
  const ExecConfig exec{ThreadPool(options.num_threads).num_threads()};
  const ModelScene scene(options.mesh, 1, exec);
  const GroundTruth truth(scene.stage().scene->mesh(), 10'000, 1, exec);
  Json json{{"mesh", options.mesh.string()}, {"views", options.views}};
  add_environment(json, exec.num_threads);
  json["consistency"] = consistency_rows(scene, truth, options, exec);
  json["refinement"] = refinement(scene, truth, exec);
  const auto ratio = [&](const char* key) {
    return json["refinement"].back()[key].get<double>() /
           json["refinement"].front()[key].get<double>();
  };
  json["refinement_ratio"] = ratio("rms_surface");
  json["refinement_ratio_points"] = ratio("rms_points");
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print(json);
  }
  return 0;
}

}  // namespace viewgain::bench
