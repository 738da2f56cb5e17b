// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/sensing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain::app {
namespace {

constexpr int kFlyingPixelSubRays = 3;

}  // namespace

bool SimulatedNoise::has_flying_pixels(const Sensor& sensor) const {
  return flying.value_or(readings) && std::isfinite(unambiguous_range(sensor.noise));
}

SimulatedNoise parse_noise(const std::string& text, bool readings) {
  SimulatedNoise noise;
  noise.readings = readings;
  for (const std::string& part : names_in(text)) {
    const std::size_t equals = part.find('=');
    const std::string word = part.substr(0, equals);
    const std::string fault =
        fault_of_name(word, {"on", "off", "plain", "flying", "scale", "pose"}, "word of --noise");
    if (!fault.empty()) refuse("--noise: " + fault);
    if ((word == "scale" || word == "pose") != (equals != std::string::npos)) {
      refuse("--noise " + part + ": scale and pose alone have a value, as in scale=0.01");
    }
    const std::string value = equals == std::string::npos ? "" : part.substr(equals + 1);
    if (word == "on" || word == "off") noise.readings = word == "on";
    if (word == "plain" || word == "flying") {
      noise.readings = word == "plain";
      noise.flying = word == "flying";
    }
    if (word == "scale") noise.scale_error = parse_numbers("--noise scale", value, 1, 1)[0];
    if (word != "pose") continue;
    std::string sigmas = value;
    std::replace(sigmas.begin(), sigmas.end(), '/', ',');
    noise.pose = parse_pose_sigma("--noise pose", sigmas);
  }
  return noise;
}

void add_sensing_options(App& app, SensingOptions& o) {
  begin_group(app, "Simulated camera");
  app.add_option("--support-plane", o.support_plane,
                 "height z of a table without end that occludes [m]; default: none");
  app.add_option(
      "--noise", o.noise,
      "off; or on: Gaussian along the ray and across it by the sensor's model, and pixels that mix "
      "the returns of 3x3 rays in sensors with a modulation frequency; plain: without these "
      "pixels; flying: these alone. With commas also scale=E: ranges read 1 + E times what they "
      "are, as by a calibration that is off; pose=SIGMA_M/SIGMA_DEG: reported poses are off by "
      "this, in each axis [m] and each component of the rotation vector [deg]; the first view's is "
      "exact and defines the world");
  app.add_option("--background", o.background,
                 "radius of a sphere round the origin that stands for the room [m]; 0: none");
  add_seed_option(app, o.seed, "of the noise of readings and of poses");
}

SimulationConfig simulation_config(const SensingOptions& options, const SimulatedNoise& noise,
                                   const Sensor& sensor) {
  SimulationConfig config;
  config.background_radius = options.background;
  config.noise = noise.readings;
  config.lateral_noise = config.noise;
  config.scale_error = noise.scale_error;
  config.seed = options.seed;
  config.sub_rays = noise.has_flying_pixels(sensor) ? kFlyingPixelSubRays : 1;
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

void add_registration_option(App& app, RegistrationOptions& options) {
  begin_group(app, "Poses that are a little wrong");
  app.add_option(
      "--register", options.text,
      "off; or on: align frames with one another, or as they arrive with the map, before "
      "they go in, and leave out those that contradict it; or the same with "
      "SIGMA_M,SIGMA_DEG by which reported poses may be off; default of these: "
      "0.005,0.5, or what --noise says");
}

std::optional<PoseSigma> stated_sigma(const RegistrationOptions& options) {
  if (options.text == "on" || options.text == "off") return std::nullopt;
  const PoseSigma stated = parse_pose_sigma("--register", options.text);
  check_positive("--register", std::min(stated.translation, stated.rotation));
  return stated;
}

std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                            const PoseSigma& noise) {
  if (!options.is_on()) return std::nullopt;
  if (const auto stated = stated_sigma(options)) return stated;
  PoseSigma sigma = kUsualPoseSigma;
  if (noise.translation > 0) sigma.translation = noise.translation;
  if (noise.rotation > 0) sigma.rotation = noise.rotation;
  return sigma;
}

namespace {

// COARSEST and FINEST.
std::array<std::size_t, 2> parse_scales(const std::string& text) {
  const std::vector<double> n = parse_numbers("--scales", text, 1, 2);
  const std::size_t coarsest = parse_count("--scales", n[0]);
  const std::size_t finest = n.size() > 1 ? parse_count("--scales", n[1]) : 0;
  if (coarsest > 3 || finest > coarsest) {
    refuse("--scales " + text + ": needs 0 <= FINEST <= COARSEST <= 3");
  }
  return {coarsest, finest};
}

}  // namespace

void ScaleOptions::set(ScorerConfig& config) const {
  const auto [coarsest, finest] = parse_scales(scales);
  if (coarsest == 0 && !fine.empty()) refuse("--fine goes with --scales");
  config.coarsest = static_cast<int>(coarsest);
  config.finest = static_cast<int>(finest);
  for (const std::string& box : fine) config.fine.push_back(parse_box("--fine", box));
}

Json ScaleOptions::settings() const {
  const auto [coarsest, finest] = parse_scales(scales);
  if (coarsest == 0) return Json::object();
  return {{"coarsest", coarsest}, {"fine", fine}, {"finest", finest}};
}

void add_scale_options(App& app, ScaleOptions& options) {
  begin_group(app, "Scales");
  app.add_option("--scales", options.scales,
                 "COARSEST[,FINEST]: up to 2^COARSEST voxels an edge are known as one cell where a "
                 "pixel is as large, 0 to 3; a nearer look makes them finer, down to 2^FINEST");
  app.add_option("--fine", options.fine,
                 "x0,y0,z0,x1,y1,z1 [m]: known by single voxels all the same; may be repeated")
      ->allow_extra_args(false);
}

}  // namespace viewgain::app
