// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

namespace viewgain::bench {

/// Adds a counter of `per_iteration` things, shown as a rate.
inline void count(benchmark::State& state, const char* what, double per_iteration) {
  state.counters[what] = benchmark::Counter(per_iteration * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate);
}

// Each registers the microbenchmarks of its source file with Google Benchmark.
void register_trace_benchmarks();
void register_feasible_benchmarks();
void register_gain_benchmarks();
void register_map_benchmarks();
void register_surface_benchmarks();

}  // namespace viewgain::bench
