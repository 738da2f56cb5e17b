// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "program/cli/app.hpp"
#include "program/cli/flags/common_options.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// One subcommand. Its options are in `app`; `run` does the work after parsing. run throws Error
/// for bad input and leaves no unfinished files.
struct Command {
  App* app = nullptr;
  std::function<void(const CommonOptions&)> run;
};

/// Makes a command that runs with `options`, whose `common` are the program's.
template <typename Options, typename Run>
[[nodiscard]] Command command_of(App* app, std::shared_ptr<Options> options, Run run) {
  return {app, [=](const CommonOptions& common) {
            options->common = common;
            run(*options);
          }};
}

[[nodiscard]] Command add_simulate(App& program);
[[nodiscard]] Command add_calibrate(App& program);
[[nodiscard]] Command add_import(App& program);
[[nodiscard]] Command add_integrate(App& program);
[[nodiscard]] Command add_score(App& program);
[[nodiscard]] Command add_reconstruct(App& program);
[[nodiscard]] Command add_model(App& program);
[[nodiscard]] Command add_next(App& program);
[[nodiscard]] Command add_info(App& program);
[[nodiscard]] Command add_convert(App& program);
[[nodiscard]] Command add_surface(App& program);
[[nodiscard]] Command add_render(App& program);
[[nodiscard]] Command add_sensors(App& program);

}  // namespace viewgain::app
