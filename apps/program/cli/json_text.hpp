// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <map>
#include <numbers>
#include <string>

#include "program/cli/json.hpp"
#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::app {

[[nodiscard]] inline Json to_json(const Box& box) {
  return {box.min[0], box.min[1], box.min[2], box.max[0], box.max[1], box.max[2]};
}

[[nodiscard]] inline Json to_json(const Pose& pose) {
  const auto& m = pose.m;
  return {{m[0], m[1], m[2], m[3]},
          {m[4], m[5], m[6], m[7]},
          {m[8], m[9], m[10], m[11]},
          {0.0, 0.0, 0.0, 1.0}};
}

/// The sigmas [m, deg]; null where both are 0.
[[nodiscard]] inline Json pose_sigma_json(const PoseSigma& sigma) {
  if (sigma == PoseSigma{}) return {};
  return {sigma.translation, sigma.rotation * 180 / std::numbers::pi};
}

/// The key `seconds`: each stage's, and their sum.
[[nodiscard]] inline Json seconds_json(const std::map<std::string, double>& seconds) {
  Json json = seconds;
  double total = 0;
  for (const auto& [stage, value] : seconds) total += value;
  json["total"] = total;
  return json;
}

/// What run.json and --json hold.
[[nodiscard]] inline std::string json_text(const Json& json) { return dumped(json, 2) + "\n"; }

inline void print_json(const Json& json) { std::fputs(json_text(json).c_str(), stdout); }

}  // namespace viewgain::app
