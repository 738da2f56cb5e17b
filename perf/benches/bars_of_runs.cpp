// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Bars whose figures other subcommands measure too.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "bars.hpp"
#include "integrate_bench.hpp"
#include "measure.hpp"
#include "sizes/peak_memory.hpp"
#include "sizes/scaling_run.hpp"
#include "support/camel_scene.hpp"
#include "trace_run.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::bench {

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
               floor = run.rate("viewgain_floor"), quads = run.rate("embree_quads");
  // All methods run on the same threads, one pose a thread: a ratio per thread is that of the
  // rates.
  return {{"gain_over_quads", gain / quads, agrees, note},
          {"gain_over_quads_fast", gain / run.fast_embree},
          {"gain_over_trace", gain / ours, agrees, note},
          {"floor_over_quads", floor / quads, agrees, note},
          {"trace_over_floor", ours / floor, agrees, note},
          {"gain_over_octomap", gain / run.rate("octomap_gain"), agrees, note},
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
  const std::vector<ScalingCase> cases = run_scaling_cases(plan);
  const bool agree =
      std::all_of(cases.begin(), cases.end(), [](const ScalingCase& c) { return c.agrees(); });
  const std::string note = agree ? "" : "answers differ";
  const auto poses_per_second = [&](std::size_t i) { return cases[i].poses_per_second(); };
  return {{"thread_scaling", poses_per_second(1) / poses_per_second(0), agree, note},
          {"cost_512_over_128", poses_per_second(1) / poses_per_second(3), agree, note}};
}

std::vector<Figure> latency_figures(const BarsOptions& options) {
  const auto scene = VoxelScene::build(test::camel_grid(options.voxels, options.mesh));
  const Sensor sensor = sensor_preset("sr4000");
  const GainEvaluator alone(scene, sensor, {.model = GainModel::paper}, {.num_threads = 1});
  const GainEvaluator together(scene, sensor, {.model = GainModel::paper},
                               {.num_threads = options.num_threads});
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
  return {{"latency_scaling", sum_together / sum_alone, same, same ? "" : "gains differ"}};
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
