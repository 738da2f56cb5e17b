// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/sensing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "program/cli/values.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain::app {
namespace {

constexpr int kFlyingPixelSubRays = 3;

}  // namespace

bool SensingOptions::has_flying_pixels(const Sensor& sensor) const {
  const bool wanted = (flying_pixels.empty() ? noise : flying_pixels) == "on";
  return wanted && std::isfinite(unambiguous_range(sensor.noise));
}

SimulationConfig simulation_config(const SensingOptions& options, const Sensor& sensor) {
  SimulationConfig config;
  config.background_radius = options.background;
  config.noise = options.noise == "on";
  config.lateral_noise = config.noise;
  config.seed = options.seed;
  config.sub_rays = options.has_flying_pixels(sensor) ? kFlyingPixelSubRays : 1;
  config.support_plane = options.support_plane;
  return config;
}

PoseSigma parse_pose_sigma(std::string_view flag, const std::string& text) {
  if (text.empty()) return {};
  const std::vector<double> sigmas = parse_numbers(flag, text, 2, 2);
  for (const double sigma : sigmas) check_at_least_0(flag, sigma);
  return {sigmas[0], sigmas[1] * std::numbers::pi / 180};
}

std::optional<JumpEdgeFilter::Config> parse_jump_edge_filter(const std::string& text) {
  if (text == "off") return std::nullopt;
  const double degrees = parse_numbers("--jump-edge-filter", text, 1, 1)[0];
  return JumpEdgeFilter::Config{degrees * std::numbers::pi / 180};
}

}  // namespace viewgain::app
