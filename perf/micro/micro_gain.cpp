// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// From hits to a gain: sums by voxel, entropy differences.
#include <benchmark/benchmark.h>

#include "gain/evaluator_core.hpp"
#include "micro_benchmarks.hpp"
#include "micro_scene.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::bench {
namespace {

// Of views traced beforehand: everything of the gain but the tracing.
void accumulation(benchmark::State& state, Criterion criterion) {
  const MicroScene& micro = MicroScene::get();
  detail::GainSettings settings;
  settings.criterion = criterion;
  settings.prior_information = 1 / (micro.grid.prior_sigma() * micro.grid.prior_sigma());
  settings.sigmas = detail::frontal_sigmas(micro.sensor);
  detail::GainAccumulator accumulator(detail::SceneAccess::data(*micro.scene), settings,
                                      micro.tracer.table().ray_count());
  std::size_t hits = 0, next = 0;
  for (auto _ : state) {
    ViewGain gain;
    accumulator.begin();
    for (const detail::RayTile& tile : micro.views[next++ % micro.views.size()].tiles) {
      accumulator.add(tile);
    }
    accumulator.finish(gain);
    benchmark::DoNotOptimize(gain.gain);
    hits += gain.hits;
  }
  state.counters["hits"] =
      benchmark::Counter(static_cast<double>(hits), benchmark::Counter::kIsRate);
}

// One voxel at a time, as the oracle and the statistics do.
void entropy_difference(benchmark::State& state, Criterion criterion) {
  SymmetricMatrix3 before, added;
  before.xx = before.yy = before.zz = 1e4;
  added.xx = 3e4, added.yy = 4e4, added.zz = 5e4, added.xy = 1e3, added.xz = -2e3, added.yz = 5e2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(added);
    benchmark::DoNotOptimize(entropy_reduction(before, added, criterion));
  }
  state.counters["voxels"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

}  // namespace

void register_gain_benchmarks() {
  for (const std::string& name : criterion_names()) {
    const Criterion criterion = parse_criterion(name);
    benchmark::RegisterBenchmark(("accumulation/" + name).c_str(), accumulation, criterion);
    benchmark::RegisterBenchmark(("entropy_difference/" + name).c_str(), entropy_difference,
                                 criterion);
  }
}

}  // namespace viewgain::bench
