// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace viewgain::bench {

// Each registers the microbenchmarks of its source with Google Benchmark.
void register_trace_benchmarks();
void register_feasible_benchmarks();
void register_gain_benchmarks();
void register_map_benchmarks();
void register_surface_benchmarks();

}  // namespace viewgain::bench
