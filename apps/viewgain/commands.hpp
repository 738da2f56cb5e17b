// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::app {

/// One subcommand: its options are in `app`, `run` does the work after parsing. run throws Error
/// for bad input; nothing half-written stays behind.
struct Command {
  CLI::App* app = nullptr;
  std::function<void()> run;
};

[[nodiscard]] Command add_simulate(CLI::App& program);
[[nodiscard]] Command add_integrate(CLI::App& program);
[[nodiscard]] Command add_score(CLI::App& program);
[[nodiscard]] Command add_reconstruct(CLI::App& program);
[[nodiscard]] Command add_candidates(CLI::App& program);
[[nodiscard]] Command add_info(CLI::App& program);
[[nodiscard]] Command add_convert(CLI::App& program);

/// What every subcommand has.
struct CommonOptions {
  bool json = false;
  int threads = 0;
};
inline void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("--json", options.json, "print one JSON object instead of text");
  app.add_option("--threads", options.threads, "threads; 0: as many as the machine has")
      ->capture_default_str();
}

inline constexpr const char* kSensorHelp =
    "preset (sr4000, azure_kinect_nfov, kinect_v1, d435, laser_line) or a .toml file";

[[nodiscard]] inline nlohmann::ordered_json to_json(const Box& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

[[nodiscard]] inline nlohmann::ordered_json to_json(const Pose& pose) {
  const auto& m = pose.m;
  return {{m[0], m[1], m[2], m[3]},
          {m[4], m[5], m[6], m[7]},
          {m[8], m[9], m[10], m[11]},
          {0.0, 0.0, 0.0, 1.0}};
}

inline void print_json(const nlohmann::ordered_json& json) {
  std::printf("%s\n", json.dump(2).c_str());
}

}  // namespace viewgain::app
