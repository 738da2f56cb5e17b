// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "environment.hpp"
#include "micro_benchmarks.hpp"

int main(int argc, char** argv) {
  try {
    nlohmann::ordered_json environment;
    viewgain::bench::add_environment(environment, 1);
    for (const auto& [key, value] : environment.items()) {
      benchmark::AddCustomContext(key, value.is_string() ? value.get<std::string>() : value.dump());
    }
    viewgain::bench::register_trace_benchmarks();
    viewgain::bench::register_feasible_benchmarks();
    viewgain::bench::register_gain_benchmarks();
    viewgain::bench::register_map_benchmarks();
    viewgain::bench::register_surface_benchmarks();
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewgain-micro: %s\n", error.what());
    return 1;
  }
}
