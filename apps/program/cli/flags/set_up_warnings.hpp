// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/raycast/suspect_frames.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {

// Warnings about values that are valid but rarely intended (suspect_set_up.hpp): one line per
// suspicion on the error output.

/// Prints "viewgain: warning: `about`: ..." if there is a suspicion; an empty `about` is left out.
void warn(const Suspicion& suspicion, const std::string& about = {});

/// The set-up of a command, as far as known.
struct SetUp {
  const Sensor& sensor;
  const BeliefGrid& map;
  /// Whether frames are compared later; suspect_frames() then names the causes that explain them.
  bool frames_follow = false;
  const std::vector<std::string>* obstacle_values = nullptr;  ///< of --obstacle
  const Obstacles* obstacles = nullptr;                       ///< obstacles_of() these
  std::optional<double> support_plane{};                      ///< --support-plane [m]
  std::string reach_file{};                                   ///< --reach
  const ReachRegion* reach = nullptr;                         ///< in it
  std::optional<double> object_size{};                        ///< of --hazard size=L [m]
  std::optional<PoseSigma> pose_sigma{};                      ///< of --register or --noise
};
void warn_of_set_up(const SetUp& set_up);

/// The sensor alone, for commands without a map.
void warn_of_sensor(const Sensor& sensor);

/// Warns if views of a map were taken inside of solid obstacles, where no view is possible.
void warn_of_views_in_obstacles(const Obstacles& obstacles, const BeliefGrid& map);

}  // namespace viewgain::app
