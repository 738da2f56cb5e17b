// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/flags/sensing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

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
  std::set<std::string> words;
  for (const std::string& part : names_in(text)) {
    const std::size_t equals = part.find('=');
    const std::string word = part.substr(0, equals);
    const std::string fault =
        fault_of_name(word, {"on", "off", "plain", "flying", "scale", "pose"}, "word");
    if (!fault.empty()) refuse("--noise: " + fault);
    const bool has_value = word == "scale" || word == "pose";
    if (has_value && equals == std::string::npos) {
      refuse("--noise " + part + ": a value is required, for example scale=0.01 or pose=0.002/0.2");
    }
    if (!has_value && equals != std::string::npos)
      refuse("--noise " + part + ": only scale and pose have values");
    if (!words.insert(has_value ? word : "readings").second) {
      refuse("--noise " + text + ": a setting is given twice");
    }
    const std::string value = has_value ? part.substr(equals + 1) : "";
    if (word == "on" || word == "off") noise.readings = word == "on";
    if (word == "plain" || word == "flying") {
      noise.readings = word == "plain";
      noise.flying = word == "flying";
    }
    if (word == "scale") noise.scale_error = parse_numbers("--noise scale", value, 1, 1)[0];
    if (word != "pose") continue;
    const std::size_t slash = value.find('/');
    if (slash == std::string::npos) {
      refuse("--noise " + part + ": expected pose=SIGMA_M/SIGMA_DEG, with a slash");
    }
    noise.pose =
        parse_pose_sigma("--noise pose", value.substr(0, slash) + "," + value.substr(slash + 1));
  }
  return noise;
}

void add_sensing_options(App& app, SensingOptions& o) {
  begin_group(app, "Simulated camera");
  app.add_option("--support-plane", o.support_plane,
                 "height z of an infinite table that hides everything below [m] (default: none)");
  const std::string reference = explain_values_in(
      "simulate", app,
      "Values of --noise, separated by commas:\n"
      "  off       no noise\n"
      "  on        the sensor's Gaussian noise along and across the ray. Sensors with a\n"
      "            modulation frequency also get flying pixels, which mix the depths of\n"
      "            3x3 rays\n"
      "  plain     Gaussian noise without flying pixels\n"
      "  flying    flying pixels only\n"
      "  scale=E   measured ranges are 1 + E times the true ones\n"
      "  pose=SIGMA_M/SIGMA_DEG  standard deviations of errors in the reported poses,\n"
      "            per axis [m] and per component of the rotation vector [deg]. The\n"
      "            first pose has no error, because it defines the world\n");
  app.add_option("--noise", o.noise,
                 "noise of depths and poses: off, on, plain, flying, scale=E, "
                 "pose=SIGMA_M/SIGMA_DEG, separated by commas (" +
                     reference + ")");
  app.add_option("--background", o.background,
                 "radius of a sphere around the origin that stands for the room [m]; 0: none");
  add_seed_option(app, o.seed, "seed for the noise of depths and poses");
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
  begin_group(app, "Registration");
  const std::string reference = explain_values_in(
      "integrate", app,
      "Values of --register:\n"
      "  off       use the reported poses\n"
      "  on        align frames with one another and leave out frames that contradict\n"
      "            the rest. integrate and model --watch align each frame with the map\n"
      "  SIGMA_M,SIGMA_DEG  like on, with these standard deviations of the reported poses\n"
      "            (default: 0.005,0.5; for reconstruct, those of --noise if given)\n");
  app.add_option("--register", options.text,
                 "correct the reported poses by aligning frames: off, on or SIGMA_M,SIGMA_DEG (" +
                     reference + ")");
}

std::optional<PoseSigma> stated_sigma(const RegistrationOptions& options) {
  if (options.text == "on" || options.text == "off") return std::nullopt;
  if (options.text.find(',') == std::string::npos) {
    refuse("--register " + options.text + ": expected on, off or SIGMA_M,SIGMA_DEG");
  }
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
    refuse("--scales " + text + ": expected 0 <= FINEST <= COARSEST <= 3");
  }
  return {coarsest, finest};
}

}  // namespace

void ScaleOptions::set(ScorerConfig& config) const {
  const auto [coarsest, finest] = parse_scales(scales);
  if (coarsest == 0 && !fine.empty()) refuse("--fine requires --scales");
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
  app.add_option(
      "--scales", options.scales,
      "COARSEST[,FINEST] (0..3): merge voxels that one pixel covers into cells up to 2^COARSEST "
      "voxels wide; closer views split them down to 2^FINEST voxels");
  app.add_option(
         "--fine", options.fine,
         "box x0,y0,z0,x1,y1,z1 [m] without merged voxels (requires --scales); may be repeated")
      ->allow_extra_args(false);
}

}  // namespace viewgain::app
