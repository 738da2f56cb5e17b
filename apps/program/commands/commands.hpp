// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "program/cli/app.hpp"
#include "program/cli/flags/common_options.hpp"
#include "program/cli/json.hpp"

namespace viewgain::app {

/// One subcommand: its options are in `app`, `run` does the work after parsing. run throws Error
/// for bad input; nothing half-written stays behind.
struct Command {
  App* app = nullptr;
  std::function<void()> run;
  /// Another form of it, with flags of its own, for a folder of frames in the place of the first
  /// positional; its app is parsed by itself.
  std::shared_ptr<Command> of_frames{};
  std::shared_ptr<App> own{};  ///< such an app
};

/// The other form of a subcommand.
[[nodiscard]] inline std::shared_ptr<App> app_of_frames(const std::string& subcommand,
                                                        const std::string& description) {
  auto app = std::make_shared<App>(description, "viewgain " + subcommand);
  app->option_defaults()->always_capture_default();
  return app;
}

/// Thrown by a command that a signal stopped before it was done: one line, exit code 130.
struct Stopped {
  std::string message;
};

[[nodiscard]] Command add_simulate(App& program);
[[nodiscard]] Command add_calibrate(App& program);
[[nodiscard]] Command add_import(App& program);
[[nodiscard]] Command add_integrate(App& program);
[[nodiscard]] Command add_score(App& program);
[[nodiscard]] Command add_reconstruct(App& program);
[[nodiscard]] Command add_reconstruct_frames();  // its other form
[[nodiscard]] Command add_candidates(App& program);
[[nodiscard]] Command add_next(App& program);
[[nodiscard]] Command add_info(App& program);
[[nodiscard]] Command add_convert(App& program);
[[nodiscard]] Command add_surface(App& program);
[[nodiscard]] Command add_render(App& program);
[[nodiscard]] Command add_sensors(App& program);
[[nodiscard]] Command add_follow(App& program);
[[nodiscard]] Command add_study(App& program);

}  // namespace viewgain::app
