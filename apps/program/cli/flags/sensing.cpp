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
constexpr std::size_t kCalibrationRanges = 200;
// Phases wrap at the unambiguous range; near it readings may be on either side.
constexpr double kUnambiguousShare = 0.98;

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
  config.wiggling = options.wiggling;
  config.support_plane = options.support_plane;
  if (options.calibrate == "on") {
    const double farthest =
        std::min(sensor.max_range, kUnambiguousShare * unambiguous_range(sensor.noise));
    const double nearest = std::max(sensor.min_range, 0.01 * farthest);
    config.calibration = measure_calibration(sensor, config, nearest, farthest, kCalibrationRanges);
  }
  return config;
}

PoseNoise parse_pose_noise(std::string_view flag, const std::string& text, std::uint64_t seed) {
  if (text.empty()) return {0, 0, seed};
  const std::vector<double> sigmas = parse_numbers(flag, text, 2, 2);
  for (const double sigma : sigmas) check_at_least_0(flag, sigma);
  return {sigmas[0], sigmas[1] * std::numbers::pi / 180, seed};
}

std::optional<JumpEdgeConfig> parse_jump_edge_filter(const std::string& text, bool two_sided) {
  if (text == "off") return std::nullopt;
  const double degrees = parse_numbers("--jump-edge-filter", text, 1, 1)[0];
  return JumpEdgeConfig{degrees * std::numbers::pi / 180, two_sided};
}

}  // namespace viewgain::app
