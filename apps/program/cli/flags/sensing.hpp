// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "program/cli/app.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/view_scorer.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// How a camera is simulated, as the command line says it.
struct SensingOptions {
  double background = 1.5;                ///< --background [m]
  std::string noise = "off";              ///< --noise
  std::uint64_t seed = 1;                 ///< --seed
  std::optional<double> support_plane{};  ///< --support-plane, world z [m]
};

/// What --noise comes to.
struct SimulatedNoise {
  bool readings = false;         ///< along and across the ray
  std::optional<bool> flying{};  ///< pixels that mix several returns; nothing: as `readings`
  double scale_error = 0;        ///< ranges read 1 + this times what they are [1]
  PoseSigma pose{};              ///< of what the camera reports

  /// Sub-rays mix only in sensors with a modulation frequency.
  [[nodiscard]] bool has_flying_pixels(const Sensor& sensor) const;
};
/// `readings`: where the text says nothing of them. Throws Error(invalid_argument).
[[nodiscard]] SimulatedNoise parse_noise(const std::string& text, bool readings);

/// Its flags, the same in every subcommand that simulates a camera.
void add_sensing_options(App& app, SensingOptions& options);

[[nodiscard]] SimulationConfig simulation_config(const SensingOptions& options,
                                                 const SimulatedNoise& noise, const Sensor& sensor);

/// SIGMA_M,SIGMA_DEG of a flag; empty: both 0. Throws Error(invalid_argument) for other text.
[[nodiscard]] PoseSigma parse_pose_sigma(std::string_view flag, const std::string& text);

/// Wherever frames go into a map.
inline constexpr const char* kJumpEdgeHelp =
    "ANGLE_DEG, 1..10, or off: remove flying pixels, whose line to a nearer neighbour is within "
    "this angle of the ray";

/// --jump-edge-filter ANGLE_DEG|off. Throws Error(invalid_argument) for other text; the filter
/// itself refuses angles out of its bounds.
[[nodiscard]] std::optional<JumpEdgeFilter::Config> parse_jump_edge_filter(const std::string& text);

/// Whether frames are registered, as the command line says it.
struct RegistrationOptions {
  std::string text = "off";  ///< --register on|off|SIGMA_M,SIGMA_DEG

  [[nodiscard]] bool is_on() const { return text != "off"; }
};

/// Is a frame that registration refused left out, by what --on-contradiction says?
[[nodiscard]] inline bool leaves_out(const FrameRegistration& registration,
                                     const std::string& on_contradiction) {
  return registration.status == RegistrationStatus::refused && on_contradiction != "keep";
}

/// --register, for frames that go into a map one after the other.
void add_registration_option(App& app, RegistrationOptions& options);

/// What --register says of the reported poses' errors; nothing where it has no numbers.
[[nodiscard]] std::optional<PoseSigma> stated_sigma(const RegistrationOptions& options);

/// By how much reported poses may be off: stated_sigma(), else `noise` (of --noise pose=) where it
/// is not 0; nothing unless frames are registered. Throws Error(invalid_argument), naming the flag.
[[nodiscard]] std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                                          const PoseSigma& noise = {});

/// --scales and --fine: which scales the leaves of a map that is made get.
struct ScaleOptions {
  std::string scales = "0";  ///< COARSEST[,FINEST]
  std::vector<std::string> fine;

  /// Throws Error(invalid_argument) naming the flag.
  void set(ScorerConfig& config) const;
  /// For a run's settings, empty where they are the defaults.
  [[nodiscard]] Json settings() const;
};

void add_scale_options(App& app, ScaleOptions& options);

}  // namespace viewgain::app
