// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "options/common_options.hpp"
#include "options/json_text.hpp"

namespace viewgain::app {

/// One subcommand: its options are in `app`, `run` does the work after parsing. run throws Error
/// for bad input; nothing half-written stays behind. The subcommand of the group "" is not shown.
struct Command {
  CLI::App* app = nullptr;
  std::function<void()> run;
};

/// Thrown by a command that a signal stopped before it was done: one line, exit code 130.
struct Stopped {
  std::string message;
};

[[nodiscard]] Command add_simulate(CLI::App& program);
[[nodiscard]] Command add_calibrate(CLI::App& program);
[[nodiscard]] Command add_import(CLI::App& program);
[[nodiscard]] Command add_integrate(CLI::App& program);
[[nodiscard]] Command add_score(CLI::App& program);
[[nodiscard]] Command add_merge(CLI::App& program);
[[nodiscard]] Command add_reconstruct(CLI::App& program);
[[nodiscard]] Command add_candidates(CLI::App& program);
[[nodiscard]] Command add_next(CLI::App& program);
[[nodiscard]] Command add_info(CLI::App& program);
[[nodiscard]] Command add_convert(CLI::App& program);
[[nodiscard]] Command add_surface(CLI::App& program);
[[nodiscard]] Command add_render(CLI::App& program);
[[nodiscard]] Command add_sensors(CLI::App& program);
[[nodiscard]] Command add_follow(CLI::App& program);
[[nodiscard]] Command add_study(CLI::App& program);

}  // namespace viewgain::app
