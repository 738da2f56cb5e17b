// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "program/commands/reconstruct/run_options.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner/simulated_acquisition.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// The set-up of a run from its flags.
struct RunSetup {
  Sensor sensor;
  ReachRegion reach{};
  Stage stage{};
  double distance = 0;  ///< distance of the start and of pose sets from the object's centre [m]
  Pose start;
  VisibilityConfig visibility{};
  SimulationConfig simulation{};
  SimulatedNoise noise{};
  /// Uncertainty of reported poses, if frames are registered.
  std::optional<PoseSigma> registration{};
  SurfaceModelConfig model{};
  GenerationConfig generation{};
  PolicyConfig policy{};
  PlanningConfig planning{};
  Json settings;  ///< settings in run.json
};

/// The policy of the options; for the oracle without the object. Throws Error.
[[nodiscard]] PolicyConfig policy_config(const ReconstructOptions& options);

/// Reads the files that the options name and checks everything. Throws Error.
[[nodiscard]] RunSetup set_up(const ReconstructOptions& options, const ExecConfig& exec);

/// The parts of Algorithm 1 on a mesh, for one run.
struct RunParts {
  /// Determines the visible samples of the mesh, which takes some tenths of a second. Throws Error.
  RunParts(RunSetup from, std::size_t frames_per_view, const ExecConfig& exec);
  RunParts(const RunParts&) = delete;
  RunParts& operator=(const RunParts&) = delete;

  /// The model, or the registered model if frames are registered.
  [[nodiscard]] RepresentationUpdate& representation() {
    return registered ? static_cast<RepresentationUpdate&>(*registered) : model;
  }
  /// Registration of each view; empty without registration.
  [[nodiscard]] std::vector<FrameRegistration> registrations() const {
    return registered ? registered->registrations() : std::vector<FrameRegistration>{};
  }

  RunSetup setup;
  std::shared_ptr<const Truth> truth;
  SimulatedAcquisition camera;
  MisreportedAcquisition acquisition;  ///< the camera with its reported poses
  SurfaceModel model;
  std::optional<RegisteredModel> registered;
  CandidateGeneration generation;
  PolicyDecision decision;
};

}  // namespace viewgain::app
