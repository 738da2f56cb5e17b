// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace viewgain::bench {

struct IntegrateOptions {
  int num_threads = 0;  ///< of viewgain; 0: all hardware threads. OctoMap has one.
  int voxels = 128;     ///< per side
  int repetitions = 9;
  std::filesystem::path mesh;
  bool json = false;
};

/// Times one more frame into camel-N, with OctoMap and with viewgain by lines and by cones.
/// Compares the maps. Returns the report. Throws Error.
[[nodiscard]] nlohmann::ordered_json measure_integrate(const IntegrateOptions& options);

/// Prints the same as a table or JSON. Returns the exit code: 1 if the maps differ without a
/// reason.
int run_integrate(const IntegrateOptions& options);

}  // namespace viewgain::bench
