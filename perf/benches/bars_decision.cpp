// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// The whole decision without the surface, frame in, best pose out; and all of its stages.
#include <algorithm>
#include <array>
#include <string_view>

#include "bars.hpp"
#include "decision_bench.hpp"
#include "measure.hpp"
#include "model_maps.hpp"
#include "model_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/planner/view_planner.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

constexpr std::size_t kViews = 8;
constexpr std::array<std::size_t, 3> kCandidates{100, 500, 2000};

}  // namespace

std::vector<Figure> decision_figures(const BarsOptions& options) {
  const ExecConfig exec{.num_threads = options.num_threads};
  const ModelScene model(options.mesh, 1, exec);
  const std::vector<Pose> views = sphere_poses(kViews + 1, kModelDistance);
  BeliefGrid before = model.empty_grid(0.4 / options.voxels);
  FrameIntegrator integrator(model.sensor(), {}, exec);
  for (std::size_t i = 0; i < kViews; ++i) {
    integrator.integrate(before, model.acquire(views[i], i), views[i]);
  }
  const DepthFrame frame = model.acquire(views[kViews], kViews);
  const auto scene_before = VoxelScene::build(before, {}, exec);
  const GainEvaluator evaluator_before(scene_before, model.sensor(), {.model = GainModel::paper},
                                       exec);

  const auto decide = [&](BeliefGrid& grid, std::span<const Pose> poses) {
    integrator.integrate(grid, frame, views[kViews]);
    const auto scene = VoxelScene::update(scene_before, grid, exec);
    return evaluator_before.with_scene(scene).best(poses, 1).indices.front();
  };
  std::array<std::vector<double>, kCandidates.size()> seconds;
  for (int repetition = -1; repetition < options.repetitions; ++repetition) {
    for (std::size_t i = 0; i < kCandidates.size(); ++i) {
      const std::vector<Pose> poses = sphere_poses(kCandidates[i], kModelDistance);
      BeliefGrid grid = before.clone();
      const double value = seconds_of([&] { (void)decide(grid, poses); });
      if (repetition >= 0) seconds[i].push_back(value);  // -1: to warm up
    }
  }
  // The same 500 by the step interface, side by side.
  ScorerConfig config{.voxel_size = before.voxel_size(),
                      .workspace = before.workspace(),
                      .T_world_grid = before.T_world_grid(),
                      .prior_sigma = before.prior_sigma()};
  config.jump_edges.reset();
  config.gain.model = GainModel::paper;
  const std::vector<Pose> given = sphere_poses(500, kModelDistance);
  std::vector<double> by_parts, by_planner;
  for (int repetition = -1; repetition < options.repetitions; ++repetition) {
    ViewPlanner planner(ViewScorer(model.sensor(), config, exec));
    for (std::size_t i = 0; i < kViews; ++i) planner.add(model.acquire(views[i], i), views[i]);
    const double planned = seconds_of([&] {
      (void)planner.add(frame, views[kViews]);
      (void)planner.rank(given, 1);
    });
    BeliefGrid grid = before.clone();
    const double parts = seconds_of([&] { (void)decide(grid, given); });
    if (repetition >= 0) by_parts.push_back(parts), by_planner.push_back(planned);
  }
  std::vector<Figure> figures{{"planner_over_decision", median(by_planner) / median(by_parts)}};
  for (std::size_t i = 0; i < kCandidates.size(); ++i) {
    figures.push_back(
        {std::string("decision_ms_") + std::to_string(kCandidates[i]), 1e3 * median(seconds[i])});
  }
  DecisionOptions stages;
  stages.num_threads = options.num_threads;
  stages.repetitions = options.repetitions;
  stages.mesh = options.mesh;
  stages.candidates = {500};
  constexpr std::array<std::string_view, 6> kTurn{
      "integrate", "scene", "hazard", "surface", "candidates", "combined 500 two stages"};
  double turn = 0;
  for (auto& [stage, milliseconds] : stage_milliseconds(stages)) {
    if (std::find(kTurn.begin(), kTurn.end(), stage) != kTurn.end()) turn += milliseconds;
    std::replace(stage.begin(), stage.end(), ' ', '_');
    figures.push_back({"stage_ms_" + stage, milliseconds});
  }
  figures.push_back({"turn_ms", turn});
  return figures;
}

}  // namespace viewgain::bench
