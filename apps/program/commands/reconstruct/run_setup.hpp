// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "program/cli/json.hpp"
#include "program/commands/reconstruct/run_options.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/stage.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::app {

/// What the flags of a run come to.
struct RunSetup {
  Sensor sensor;
  ReachRegion reach{};
  Stage stage{};
  double distance = 0;  ///< of the start and of sets of poses from the object's centre [m]
  Pose start;
  VisibilityConfig visibility{};
  SimulationConfig simulation{};
  PoseSigma pose_noise{};  ///< of what the camera reports
  /// Of reported poses, by which frames are registered; its pose says nothing. None: they are not.
  std::optional<PoseSigma> registration{};
  SurfaceModelConfig model{};
  GenerationConfig generation{};
  PolicyConfig policy{};
  PlanningConfig planning{};
  Json settings;  ///< of run.json
};

/// How the options say that views are chosen; of the oracle without its object. Throws Error.
[[nodiscard]] PolicyConfig policy_config(const ReconstructOptions& options);

/// Reads the files that the options name and checks everything. Throws Error.
[[nodiscard]] RunSetup set_up(const ReconstructOptions& options, const ExecConfig& exec);

}  // namespace viewgain::app
