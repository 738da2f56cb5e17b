// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/stop_rules.hpp"

#include <vector>

#include "program/cli/help.hpp"
#include "program/cli/values.hpp"

namespace viewgain::app {

void add_stop_option(App& app, std::string& text) {
  const std::string reference = explain_values_in(
      "reconstruct", app,
      "Rules of --stop (LIMIT 0 disables a rule, except coverage):\n"
      "  gain      the best view gains less than LIMIT per voxel that it sees\n"
      "            (--gain paper; default: 1.2 nat, for trace 0.01 of the first value)\n"
      "  area      the best view's expected new surface, averaged over three decisions,\n"
      "            is below LIMIT times the surface so far (--gain surface, combined;\n"
      "            default: 0.004)\n"
      "  idle      LIMIT views in a row change entropy and unknown voxels by less than\n"
      "            0.1 % (default: 3)\n"
      "  promises  LIMIT views in a row bring less than a fifth of what was predicted\n"
      "            (default: 3)\n"
      "  coverage  a fraction LIMIT of the visible surface is covered (reconstruct only)\n");
  app.add_option("--stop", text,
                 "RULE=LIMIT,...: rules that end the run: gain, area, idle, promises, coverage (" +
                     reference + "); may be repeated")
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
    if (equals == std::string::npos) refuse(part + ": a limit is required, for example idle=3");
    const std::string flag = rule;
    const double limit = parse_numbers(flag, part.substr(equals + 1), 1, 1)[0];
    check_at_least_0(flag, limit);
    if (rule == "gain") limits.gain = limit;
    if (rule == "area") limits.area = limit;
    if (rule == "idle") limits.idle = parse_count(flag, limit);
    if (rule == "promises") limits.promises = parse_count(flag, limit);
    if (rule != "coverage") continue;
    if (limit > 1) refuse(flag + "=" + part.substr(equals + 1) + ": the limit must be in 0..1");
    limits.coverage = limit;
  }
  return limits;
}

}  // namespace viewgain::app
