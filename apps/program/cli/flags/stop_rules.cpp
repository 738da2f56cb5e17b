// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/stop_rules.hpp"

#include <vector>

#include "program/cli/help.hpp"
#include "program/cli/values.hpp"

namespace viewgain::app {

void add_stop_option(App& app, std::string& text) {
  begin_group(app, "When to stop");
  app.add_option(
         "--stop", text,
         "RULE=LIMIT,...: gain (by --gain paper: the best view gains less per touched voxel [nat, "
         "m^2]; default 1.2, trace 0.01 of the first view's), area (by surface and combined: the "
         "best "
         "candidate promises less than this share of the surface so far as new surface, on the "
         "mean "
         "of three decisions; default 0.004), idle (so many views in a row change entropy and "
         "unknown "
         "voxels by less than 0.1 %; default 3), promises (so many views in a row bring less than "
         "a "
         "fifth of what they promised; default 3), coverage (of the visible surface, 0..1, where "
         "the "
         "mesh is known); 0: never; may be repeated")
      ->join(',')
      ->check(CLI::Validator(
          [](std::string& value) {
            try {
              (void)stop_limits(value);
              return std::string();
            } catch (const Error& error) {
              return std::string(error.what());
            }
          },
          ""));
}

StopLimits stop_limits(const std::string& text) {
  StopLimits limits;
  for (const std::string& part : names_in(text)) {
    const std::size_t equals = part.find('=');
    const std::string rule = part.substr(0, equals);
    const std::string fault =
        fault_of_name(rule, {"gain", "area", "idle", "promises", "coverage"}, "rule");
    if (!fault.empty()) refuse(fault);
    if (equals == std::string::npos) refuse(part + ": needs a limit, as in idle=3");
    const std::string flag = rule;
    const double limit = parse_numbers(flag, part.substr(equals + 1), 1, 1)[0];
    check_at_least_0(flag, limit);
    if (rule == "gain") limits.gain = limit;
    if (rule == "area") limits.area = limit;
    if (rule == "idle") limits.idle = parse_count(flag, limit);
    if (rule == "promises") limits.promises = parse_count(flag, limit);
    if (rule != "coverage") continue;
    if (limit > 1) refuse(flag + "=" + part.substr(equals + 1) + " must be in 0..1");
    limits.coverage = limit;
  }
  return limits;
}

}  // namespace viewgain::app
