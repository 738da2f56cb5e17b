// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "model_maps.hpp"

#include <algorithm>

#include "model_scene.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr std::size_t kNextViews = 200;
constexpr int kNextViewStride = 4;

/// The best of the poses that is not among the views.
Pose next_view(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
               const std::vector<Pose>& poses, const std::vector<Pose>& views,
               const ExecConfig& exec) {
  const GainEvaluator evaluator(scene, sensor,
                                {.model = GainModel::paper, .pixel_stride = kNextViewStride}, exec);
  const std::vector<std::size_t> order = best_indices(evaluator.evaluate(poses), poses.size());
  const auto untaken = std::find_if(order.begin(), order.end(), [&](std::size_t i) {
    return std::find(views.begin(), views.end(), poses[i]) == views.end();
  });
  return poses[untaken == order.end() ? order.front() : *untaken];
}

/// The maps of one model; false ends all.
bool visit_model(const ModelMapPlan& plan, const std::filesystem::path& mesh, std::uint64_t seed,
                 const ExecConfig& exec, const std::function<bool(const ModelMap&)>& visit) {
  const ModelScene model(mesh, seed, exec);
  const Stage& stage = model.stage();
  const std::vector<Pose> poses = sphere_poses(kNextViews, kModelDistance, stage.center);
  double side = 0;  // the longest [m]
  for (std::size_t k = 0; k < 3; ++k) {
    side = std::max(side, stage.workspace.max[k] - stage.workspace.min[k]);
  }
  BeliefGrid grid = model.empty_grid(side / plan.voxels);
  FrameIntegrator integrator(model.sensor(), {}, exec);
  Pose pose = default_start(stage, kModelDistance, seed, {}, {});
  for (int views = 1; views <= plan.views.back(); ++views) {
    integrator.integrate(grid, model.acquire(pose, static_cast<std::uint64_t>(views - 1)), pose);
    const auto scene = VoxelScene::build(grid, {}, exec);
    const bool is_wanted =
        std::find(plan.views.begin(), plan.views.end(), views) != plan.views.end();
    if (is_wanted && !visit({mesh, seed, views, scene})) return false;
    pose = next_view(scene, model.sensor(), poses, grid.views(), exec);
  }
  return true;
}

}  // namespace

std::vector<std::filesystem::path> object_meshes() {
  const std::filesystem::path folder = VIEWGAIN_MESH_FOLDER;
  return {test::camel_mesh_path(), folder / "lion-head.off", folder / "mannequin-devil.off",
          folder / "armadillo.off", folder / "bunny00.off"};
}

void for_each_model_map(const ModelMapPlan& plan, const ExecConfig& exec,
                        const std::function<void(const ModelMap&)>& visit) {
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= plan.seeds; ++seed) {
    for (const std::filesystem::path& mesh : plan.meshes) {
      const bool goes_on = visit_model(plan, mesh, seed, exec, [&](const ModelMap& map) {
        visit(map);
        return ++count < plan.most;
      });
      if (!goes_on) return;
    }
  }
}

}  // namespace viewgain::bench
