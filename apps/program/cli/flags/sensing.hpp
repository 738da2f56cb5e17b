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

/// Options for simulating a camera.
struct SensingOptions {
  double background = 1.5;                ///< --background [m]
  std::string noise = "off";              ///< --noise
  std::uint64_t seed = 1;                 ///< --seed
  std::optional<double> support_plane{};  ///< --support-plane, world z [m]
};

/// The noise that --noise selects.
struct SimulatedNoise {
  bool readings = false;         ///< whether there is noise along and across the ray
  std::optional<bool> flying{};  ///< whether pixels mix several returns; empty: as `readings`
  double scale_error = 0;        ///< relative error of all ranges, dimensionless
  PoseSigma pose{};              ///< errors of the reported poses

  /// Sub-rays mix only in sensors with a modulation frequency.
  [[nodiscard]] bool has_flying_pixels(const Sensor& sensor) const;
};
/// `readings`: default if the text does not state it. Throws Error(invalid_argument).
[[nodiscard]] SimulatedNoise parse_noise(const std::string& text, bool readings);

/// Adds the flags of SensingOptions, which are the same in every subcommand that simulates a
/// camera.
void add_sensing_options(App& app, SensingOptions& options);

[[nodiscard]] SimulationConfig simulation_config(const SensingOptions& options,
                                                 const SimulatedNoise& noise, const Sensor& sensor);

/// Parses SIGMA_M,SIGMA_DEG of a flag; an empty text means zeros. Throws Error(invalid_argument)
/// for other text.
[[nodiscard]] PoseSigma parse_pose_sigma(std::string_view flag, const std::string& text);

/// Help of --jump-edge-filter in all subcommands.
inline constexpr const char* kJumpEdgeHelp =
    "ANGLE_DEG (1..10) or off: remove flying pixels, whose line to a nearer neighbour is "
    "within this angle of the ray";

/// Parses --jump-edge-filter ANGLE_DEG|off. Throws Error(invalid_argument) for other text; the
/// filter itself refuses angles outside its bounds.
[[nodiscard]] std::optional<JumpEdgeFilter::Config> parse_jump_edge_filter(const std::string& text);

/// Whether frames are registered.
struct RegistrationOptions {
  std::string text = "off";  ///< --register on|off|SIGMA_M,SIGMA_DEG

  [[nodiscard]] bool is_on() const { return text != "off"; }
};

/// Whether a frame is left out because registration refused it, according to --on-contradiction.
[[nodiscard]] inline bool leaves_out(const FrameRegistration& registration,
                                     const std::string& on_contradiction) {
  return registration.status == RegistrationStatus::refused && on_contradiction != "keep";
}

/// Adds --register, for frames that go into a map one after the other.
void add_registration_option(App& app, RegistrationOptions& options);

/// Errors of the reported poses according to --register; empty if it has no numbers.
[[nodiscard]] std::optional<PoseSigma> stated_sigma(const RegistrationOptions& options);

/// Uncertainty of reported poses: stated_sigma(), else `noise` (of --noise pose=) if it is not 0.
/// Empty unless frames are registered. Throws Error(invalid_argument), naming the flag.
[[nodiscard]] std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                                          const PoseSigma& noise = {});

/// --scales and --fine: scales of the leaves of a new map.
struct ScaleOptions {
  std::string scales = "0";  ///< COARSEST[,FINEST]
  std::vector<std::string> fine;

  /// Throws Error(invalid_argument) naming the flag.
  void set(ScorerConfig& config) const;
  /// For a run's settings; empty for the defaults.
  [[nodiscard]] Json settings() const;
};

void add_scale_options(App& app, ScaleOptions& options);

}  // namespace viewgain::app
