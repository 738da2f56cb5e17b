// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "iteration_bench.hpp"

#include <array>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "environment.hpp"
#include "measure.hpp"
#include "model_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/planner/pose_sets.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

constexpr int kViews = 8;
constexpr std::array kStages{"integrate", "snapshot", "surface", "candidates", "score"};

// The feasible boundary candidates, thinned evenly or filled up from the sphere to `count`.
std::vector<Pose> exactly(std::vector<Pose> poses, std::size_t count, double distance) {
  if (poses.size() < count) {
    const std::vector<Pose> more = sphere_poses(count - poses.size(), distance);
    poses.insert(poses.end(), more.begin(), more.end());
  }
  std::vector<Pose> result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(poses[i * poses.size() / count]);
  return result;
}

}  // namespace

int run_iteration(const IterationOptions& options) {
  const ExecConfig exec{ThreadPool(options.num_threads).num_threads()};
  const ModelScene scene(options.mesh, 1, exec);
  const double voxel = 0.4 / options.voxels;
  const double distance = filling_distance(scene.sensor(), 0.175);
  const std::vector<Pose> views = sphere_poses(kViews + 1, distance);
  BeliefGrid before = scene.empty_grid(voxel);
  FrameIntegrator integrator(scene.sensor(), {}, exec);
  for (std::size_t i = 0; i < kViews; ++i) {
    integrator.integrate(before, scene.acquire(views[i], i), views[i]);
  }
  const DepthFrame frame = scene.acquire(views[kViews], kViews);

  std::map<std::string, std::vector<double>> seconds;
  std::size_t points = 0, vertices = 0, boundary = 0;
  for (int repetition = -1; repetition < options.repetitions; ++repetition) {  // -1: to warm up
    BeliefGrid grid = before.clone();
    std::map<std::string, double> now;
    std::shared_ptr<const VoxelScene> voxels;
    SurfaceMesh surface;
    std::vector<Pose> poses;
    now["integrate"] = seconds_of([&] { integrator.integrate(grid, frame, views[kViews]); });
    now["snapshot"] = seconds_of([&] { voxels = VoxelScene::build(grid, {}, exec); });
    now["surface"] = seconds_of([&] {
      const std::vector<FusedPoint> fused = fused_points(grid, {}, exec);
      points = fused.size();
      surface = surface_of(fused, pooling_of(voxels->snapshot()), exec);
    });
    vertices = surface.vertices.size();
    now["candidates"] = seconds_of([&] {
      const EstimatedViews estimated =
          estimate_views(surface, grid.views(), scene.sensor(), scene.sensor().working_distance,
                         default_estimator(voxel));
      const FeasibilityChecker checker(voxels, {});
      for (const BoundaryCandidate& c : estimated.candidates) {
        if (checker.check(c.T_world_camera, grid.views()) == Infeasibility::none) {
          poses.push_back(c.T_world_camera);
        }
      }
      boundary = poses.size();
    });
    poses = exactly(std::move(poses), static_cast<std::size_t>(options.candidates), distance);
    now["score"] = seconds_of([&] {
      const GainEvaluator evaluator(voxels, scene.sensor(), {.model = GainModel::paper}, exec);
      (void)best_indices(evaluator.evaluate(poses), 1);
    });
    if (repetition < 0) continue;
    double total = 0;
    for (const auto& [stage, value] : now) seconds[stage].push_back(value), total += value;
    seconds["total"].push_back(total);
    seconds["total_without_surface"].push_back(total - now["surface"] - now["candidates"]);
  }

  nlohmann::ordered_json json{{"scene", "camel-" + std::to_string(options.voxels)},
                              {"views", kViews},
                              {"candidates", options.candidates},
                              {"boundary_candidates", boundary},
                              {"points", points},
                              {"vertices", vertices}};
  add_environment(json, exec.num_threads);
  const auto put = [&](const std::string& stage) {
    const std::vector<double>& s = seconds.at(stage);
    json["milliseconds"][stage] = {{"median", 1e3 * median(s)},
                                   {"p05", 1e3 * quantile(s, 0.05)},
                                   {"p95", 1e3 * quantile(s, 0.95)}};
  };
  for (const char* stage : kStages) put(stage);
  put("total");
  put("total_without_surface");
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
    return 0;
  }
  std::printf("one iteration after %d views of camel-%d, %d candidates, %d threads, %s\n", kViews,
              options.voxels, options.candidates, exec.num_threads, cpu_name().c_str());
  std::printf("%zu points, %zu vertices, %zu boundary candidates\n", points, vertices, boundary);
  std::printf("%-22s %10s %10s %10s\n", "stage", "ms", "p05", "p95");
  for (const auto& [stage, ms] : json["milliseconds"].items()) {
    std::printf("%-22s %10.1f %10.1f %10.1f\n", stage.c_str(), ms["median"].get<double>(),
                ms["p05"].get<double>(), ms["p95"].get<double>());
  }
  return 0;
}

}  // namespace viewgain::bench
