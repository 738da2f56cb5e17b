// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/sensing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "program/cli/values.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/planner/register_frame.hpp"

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
  config.scale_error = options.scale_error;
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

void add_registration_options(App& app, RegistrationOptions& options) {
  app.add_option("--register", options.is_on,
                 "register each frame against the map before it goes in; one that "
                 "contradicts the map is left out")
      ->capture_default_str()
      ->on_or_off();
  app.add_option("--pose-sigma", options.pose_sigma,
                 "SIGMA_M,SIGMA_DEG by which reported poses may be off, of --register; default: "
                 "0.005,0.5");
  app.add_option("--on-contradiction", options.on_contradiction,
                 "what --register does with a frame that contradicts the others: skip, or keep it "
                 "at its reported pose")
      ->capture_default_str()
      ->one_of({"skip", "keep"}, "answer");
}

std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                            const PoseSigma& noise) {
  if (options.is_on != "on") {
    if (options.pose_sigma.empty()) return std::nullopt;
    refuse("--pose-sigma " + options.pose_sigma + " goes with --register on");
  }
  if (!options.pose_sigma.empty()) {
    const PoseSigma stated = parse_pose_sigma("--pose-sigma", options.pose_sigma);
    check_positive("--pose-sigma", std::min(stated.translation, stated.rotation));
    return stated;
  }
  PoseSigma sigma = kUsualPoseSigma;
  if (noise.translation > 0) sigma.translation = noise.translation;
  if (noise.rotation > 0) sigma.rotation = noise.rotation;
  return sigma;
}

}  // namespace viewgain::app
