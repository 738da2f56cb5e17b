// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "program/cli/app.hpp"
#include "program/cli/help.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::app {

/// Options of the program itself, before or after the subcommand's name.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  int threads = 0;
  std::string trace = "automatic";
  std::string save_config;
};
inline void add_common_options(App& program, CommonOptions& options) {
  program.add_flag("--json", options.json, "print one JSON object instead of text");
  program.add_flag("--quiet", options.quiet, "do not print progress");
  program.add_option("--threads", options.threads, "number of threads (0: all cores)");
  program
      .add_option("--trace", options.trace,
                  "ray tracer: embree (bounding volume hierarchy), sweep (cell by cell) or "
                  "automatic (chosen per map); affects only the speed")
      ->check(one_of(tracer_names(), "tracer"));
  program.add_option("--save-config", options.save_config,
                     "TOML file to which the flags of this call are written; --config reads it");
}

[[nodiscard]] inline ExecConfig exec_of(const CommonOptions& options) {
  return {options.threads, parse_tracer(options.trace)};
}

// Groups of subcommands in the program's help.
inline constexpr const char* kLoopGroup = "The whole loop";
inline constexpr const char* kMapGroup = "Make a map";
inline constexpr const char* kViewsGroup = "Choose views";
inline constexpr const char* kLookGroup = "Look and convert";

/// Sets the subcommand's group in the program's help, and an example that works after the examples
/// of the earlier commands. Help shows defaults, except of options that are required or may be
/// repeated. Call it last.
inline void add_help(App& app, const char* group, const char* example) {
  for (Option* option : app.get_options()) {
    if (option->get_required() || option->get_expected_max() > 1) option->default_str("");
  }
  app.group(group)->footer(app.get_footer() + "Example:\n  viewgain " + example);
}

inline constexpr const char* kMapHelp = "map file (.vdb, or OctoMap .ot or .bt) or folder of a run";

inline const std::string kSensorHelp =
    "sensor preset (" + listed(sensor_preset_names()) + ") or .toml file";

inline const std::string kMapSensorHelp = kSensorHelp + " (default: the sensor that the map names)";

inline constexpr const char* kBodyHelp =
    "x,y,z: width, height and depth of the camera's housing [m] (default: from the sensor, else of "
    "the SR4000)";

/// Adds --seed, with the same bounds in every subcommand.
inline void add_seed_option(App& app, std::uint64_t& seed, const char* of_what) {
  app.add_option("--seed", seed, of_what)->check(a_seed());
}

}  // namespace viewgain::app
