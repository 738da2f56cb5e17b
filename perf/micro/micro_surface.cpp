// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later

// From the map to candidate views: fused points, surface, candidates at its boundaries.
#include <benchmark/benchmark.h>

#include "micro_benchmarks.hpp"
#include "micro_scene.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"

namespace viewgain::bench {
namespace {

void points(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  std::size_t n = 0;
  for (auto _ : state) n = fused_points(micro.grid, {}, {.num_threads = 1}).size();
  count(state, "points", static_cast<double>(n));
}

void surface(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  const std::vector<FusedPoint> fused = fused_points(micro.grid, {}, {.num_threads = 1});
  for (auto _ : state) {
    benchmark::DoNotOptimize(surface_of(fused, {.num_threads = 1}).vertices.size());
  }
  count(state, "points", static_cast<double>(fused.size()));
}

void candidates(benchmark::State& state) {
  const MicroScene& micro = MicroScene::get();
  const double voxel = micro.grid.voxel_size();
  const SurfaceMesh mesh =
      surface_of(fused_points(micro.grid, {}, {.num_threads = 1}), {.num_threads = 1});
  std::size_t n = 0;
  for (auto _ : state) {
    n = estimate_views(mesh, micro.grid.views(), micro.sensor, micro.sensor.working_distance,
                       default_estimator(voxel))
            .candidates.size();
  }
  count(state, "candidates", static_cast<double>(n));
}

}  // namespace

void register_surface_benchmarks() {
  using Entry = std::pair<const char*, void (*)(benchmark::State&)>;
  for (const auto& [name, function] : {Entry("fused_points", points), Entry("surface", surface),
                                       Entry("candidates", candidates)}) {
    benchmark::RegisterBenchmark(name, function)->Unit(benchmark::kMillisecond)->UseRealTime();
  }
}

}  // namespace viewgain::bench
