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
#include "program/cli/json.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/view_scorer.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::app {

/// How a camera is simulated, as the command line says it.
struct SensingOptions {
  double background = 1.5;                ///< --background [m]
  std::string noise = "off";              ///< --noise on|off: axial and lateral
  std::string flying_pixels;              ///< --flying-pixels on|off; empty: as --noise
  std::uint64_t seed = 1;                 ///< --seed
  std::optional<double> support_plane{};  ///< --support-plane, world z [m]
  double scale_error = 0;                 ///< --scale-error [1]
  std::string pose_noise;                 ///< --pose-noise SIGMA_M,SIGMA_DEG; empty: none

  /// Sub-rays mix only in sensors with a modulation frequency.
  [[nodiscard]] bool has_flying_pixels(const Sensor& sensor) const;
};

/// Its flags, the same in every subcommand that simulates a camera.
void add_sensing_options(App& app, SensingOptions& options);

[[nodiscard]] SimulationConfig simulation_config(const SensingOptions& options,
                                                 const Sensor& sensor);

/// SIGMA_M,SIGMA_DEG of a flag; empty: both 0. Throws Error(invalid_argument) for other text.
[[nodiscard]] PoseSigma parse_pose_sigma(std::string_view flag, const std::string& text);

/// Wherever frames go into a map.
inline constexpr const char* kJumpEdgeHelp =
    "ANGLE_DEG of the filter that takes flying pixels: a reading goes when the edge to a nearer "
    "neighbour is within 1..10 degrees of its ray; or off";

/// --jump-edge-filter ANGLE_DEG|off. Throws Error(invalid_argument) for other text; the filter
/// itself refuses angles out of its bounds.
[[nodiscard]] std::optional<JumpEdgeFilter::Config> parse_jump_edge_filter(const std::string& text);

/// Whether frames are registered, as the command line says it.
struct RegistrationOptions {
  std::string is_on = "off";  ///< --register on|off
  std::string pose_sigma;     ///< --pose-sigma SIGMA_M,SIGMA_DEG; empty: the default
};

/// Is a frame that registration refused left out, by what --on-contradiction says?
[[nodiscard]] inline bool leaves_out(const FrameRegistration& registration,
                                     const std::string& on_contradiction) {
  return registration.status == RegistrationStatus::refused && on_contradiction != "keep";
}

/// --register and --pose-sigma, for frames that go into a map one after the other.
void add_registration_options(App& app, RegistrationOptions& options);

/// By how much reported poses may be off: what --pose-sigma says, else `noise` (--pose-noise) where
/// it is not 0; nothing without --register on. Throws Error(invalid_argument), naming the flag,
/// also for --pose-sigma without --register on.
[[nodiscard]] std::optional<PoseSigma> registration_sigma(const RegistrationOptions& options,
                                                          const PoseSigma& noise = {});

/// What --pose-sigma says; nothing without it.
[[nodiscard]] inline std::optional<PoseSigma> stated_sigma(const RegistrationOptions& options) {
  if (options.pose_sigma.empty()) return std::nullopt;
  return parse_pose_sigma("--pose-sigma", options.pose_sigma);
}

/// --coarsest, --fine and --finest: which scales the leaves of a map that is made get.
struct ScaleOptions {
  std::size_t coarsest = 0, finest = 0;
  std::vector<std::string> fine;

  /// Throws Error(invalid_argument) naming --fine or --finest.
  void set(ScorerConfig& config) const;
  /// For a run's settings, empty where they are the defaults.
  [[nodiscard]] Json settings() const;
};

void add_scale_options(App& app, ScaleOptions& options);

}  // namespace viewgain::app
