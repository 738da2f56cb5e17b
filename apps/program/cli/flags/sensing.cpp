// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/sensing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "program/cli/flags/common_options.hpp"
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

void add_sensing_options(App& app, SensingOptions& o) {
  app.add_option("--support-plane", o.support_plane,
                 "height z of a table without end that occludes [m]; default: none");
  add_switch(app, "--noise", o.noise,
             "Gaussian noise along the ray and across it by the sensor's model");
  app.add_option("--flying-pixels", o.flying_pixels,
                 "mix the returns of 3x3 rays in a pixel, in sensors with a modulation frequency; "
                 "default: as --noise")
      ->check(on_or_off());
  app.add_option("--background", o.background,
                 "radius of a sphere round the origin that stands for the room [m]; 0: none");
  app.add_option("--scale-error", o.scale_error,
                 "ranges read 1 + this times what they are, as by a calibration that is off");
  app.add_option("--pose-noise", o.pose_noise,
                 "SIGMA_M,SIGMA_DEG: reported poses are off by this, in each axis [m] and each "
                 "component of the rotation vector [deg]; the first view's is exact and defines "
                 "the world; default: none");
  add_seed_option(app, o.seed, "of the noise of readings and of poses");
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
  add_switch(app, "--register", options.is_on,
             "register each frame against the map before it goes in; one that "
             "contradicts the map is left out");
  app.add_option("--pose-sigma", options.pose_sigma,
                 "SIGMA_M,SIGMA_DEG by which reported poses may be off, of --register; default: "
                 "0.005,0.5");
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

void ScaleOptions::set(ScorerConfig& config) const {
  if (coarsest == 0 && !fine.empty()) refuse("--fine goes with --coarsest");
  if (finest > coarsest) refuse("--finest is at most --coarsest");
  config.coarsest = static_cast<int>(coarsest);
  config.finest = static_cast<int>(finest);
  for (const std::string& box : fine) config.fine.push_back(parse_box("--fine", box));
}

Json ScaleOptions::settings() const {
  Json json = Json::object();
  if (coarsest > 0) json.update(Json{{"coarsest", coarsest}, {"fine", fine}, {"finest", finest}});
  return json;
}

void add_scale_options(App& app, ScaleOptions& options) {
  app.add_option(
         "--coarsest", options.coarsest,
         "up to 2^this voxels an edge are known as one cell where a pixel is as large, 0 to "
         "3; a nearer look makes them finer")
      ->check(counted(0, 3));
  app.add_option("--fine", options.fine,
                 "x0,y0,z0,x1,y1,z1 [m]: known by single voxels all the same; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--finest", options.finest,
                 "outside of --fine cells are no smaller than 2^this voxels an edge, 0 to 3")
      ->check(counted(0, 3));
}

}  // namespace viewgain::app
