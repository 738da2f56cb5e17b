// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Bars whose figures other subcommands measure too.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "bars.hpp"
#include "integrate_bench.hpp"
#include "measure.hpp"
#include "sizes/peak_memory.hpp"
#include "sizes/scaling_run.hpp"
#include "support/camel_scene.hpp"
#include "trace_run.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::bench {
namespace {

// Both tracers, and what the names of their figures end in.
constexpr std::array kTracers{std::pair(ExecConfig::Tracer::sweep, ""),
                              std::pair(ExecConfig::Tracer::embree, "_embree")};

// 200 poses one by one, by evaluators of one and of all threads, alternately.
Figure latency_figure(const BarsOptions& options, const std::shared_ptr<const VoxelScene>& scene,
                      ExecConfig::Tracer tracer) {
  const Sensor sensor = sensor_preset("sr4000");
  const GainConfig paper{.model = GainModel::paper};
  const GainEvaluator alone(scene, sensor, paper, {1, tracer});
  const GainEvaluator together(scene, sensor, paper, {options.num_threads, tracer});
  const std::vector<Pose> poses = sphere_poses(static_cast<std::size_t>(options.poses), 0.6);
  // Of each pose the median counts, so that a pose that was interrupted does not.
  double sum_alone = 0, sum_together = 0;
  bool same = true;
  for (const Pose& pose : poses) {
    std::vector<double> seconds_alone, seconds_together;
    for (int repetition = -1; repetition < options.repetitions; ++repetition) {
      ViewGain a, b;
      const double of_alone = seconds_of([&] { a = alone.evaluate(pose); });
      const double of_together = seconds_of([&] { b = together.evaluate(pose); });
      same = same && a.gain == b.gain;
      if (repetition < 0) continue;  // warming up
      seconds_alone.push_back(of_alone);
      seconds_together.push_back(of_together);
    }
    sum_alone += median(seconds_alone);
    sum_together += median(seconds_together);
  }
  return {"latency_scaling", sum_together / sum_alone, same, same ? "" : "gains differ"};
}

}  // namespace

std::vector<Figure> trace_figures(const BarsOptions& options) {
  TraceOptions trace;
  trace.num_threads = options.num_threads;
  trace.voxels = options.voxels;
  trace.poses = options.poses;
  trace.repetitions = options.repetitions;
  trace.mesh = options.mesh;
  const TraceRun run = run_trace_methods(trace);
  const bool agrees = run.agrees();
  const std::string note = run.disagreement();
  const double gain = run.rate("viewgain_gain"), ours = run.rate("viewgain_trace"),
               gain_embree = run.rate("viewgain_gain_embree"), floor = run.rate("viewgain_floor"),
               quads = run.rate("embree_quads");
  // All methods run on the same threads, one pose a thread: a ratio per thread is that of the
  // rates.
  return {{"gain_over_quads", gain / quads, agrees, note},
          {"gain_over_quads_fast", gain / run.fast_embree},
          {"gain_over_trace", gain / ours, agrees, note},
          {"floor_over_quads", floor / quads, agrees, note},
          {"trace_over_floor", ours / floor, agrees, note},
          {"gain_over_octomap", gain / run.rate("octomap_gain"), agrees, note},
          {"gain_embree_over_quads", gain_embree / quads, agrees, note},
          {"gain_embree_over_gain", gain_embree / gain, agrees, note},
          {"trace_embree_over_trace", run.rate("viewgain_trace_embree") / ours, agrees, note},
          {"surface_over_paper", run.rate("viewgain_surface") / gain, agrees, note},
          {"combined_over_paper", run.rate("viewgain_combined") / gain, agrees, note},
          {"build_ms", median(run.build_ms)}};
}

std::vector<Figure> scaling_figures(const BarsOptions& options) {
  ScalingPlan plan;
  plan.voxels = {options.voxels, options.large_voxels};
  plan.rays = {kFullRays};
  plan.threads = {1, options.num_threads};
  plan.poses = options.poses;
  plan.repetitions = options.repetitions;
  plan.mesh = options.mesh;
  std::vector<Figure> figures;
  for (const auto& [tracer, by] : kTracers) {
    plan.tracer = tracer;
    const std::vector<ScalingCase> cases = run_scaling_cases(plan);
    const bool agree =
        std::all_of(cases.begin(), cases.end(), [](const ScalingCase& c) { return c.agrees(); });
    const std::string note = agree ? "" : "answers differ";
    const auto rate = [&](std::size_t i) { return cases[i].poses_per_second(); };
    figures.push_back({std::string("thread_scaling") + by, rate(1) / rate(0), agree, note});
    figures.push_back({std::string("cost_512_over_128") + by, rate(1) / rate(3), agree, note});
  }
  return figures;
}

std::vector<Figure> latency_figures(const BarsOptions& options) {
  const auto scene = VoxelScene::build(test::camel_grid(options.voxels, options.mesh));
  std::vector<Figure> figures;
  for (const auto& [tracer, by] : kTracers) {
    figures.push_back(latency_figure(options, scene, tracer));
    figures.back().name += by;
  }
  return figures;
}

std::vector<Figure> integrate_figures(const BarsOptions& options) {
  IntegrateOptions integrate;
  integrate.num_threads = options.num_threads;
  integrate.voxels = options.voxels;
  integrate.repetitions = options.repetitions;
  integrate.mesh = options.mesh;
  const nlohmann::ordered_json json = measure_integrate(integrate);
  const bool agrees = json["agree"];
  return {{"octomap_over_integrate", json["ratios"]["octomap/viewgain_cones"], agrees,
           agrees ? "" : "maps differ"}};
}

std::vector<Figure> memory_figures(const BarsOptions& options) {
  constexpr int kViews = 8;
  const MemoryFigures figures =
      measure_memory({options.num_threads, options.large_voxels, kViews, options.mesh});
  return {{"memory_mb", static_cast<double>(figures.peak) / 1e6}};
}

}  // namespace viewgain::bench
