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

/// What the flags of a run come to.
struct RunSetup {
  Sensor sensor;
  ReachRegion reach{};
  Stage stage{};
  double distance = 0;  ///< of the start and of sets of poses from the object's centre [m]
  Pose start;
  VisibilityConfig visibility{};
  SimulationConfig simulation{};
  SimulatedNoise noise{};
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

/// The parts of Algorithm 1 on a mesh, wired up as a run's flags say. For one run.
struct RunParts {
  /// Finds which samples of the mesh are visible, which takes some tenths of a second. Throws
  /// Error.
  RunParts(RunSetup from, std::size_t frames_per_view, const ExecConfig& exec);
  RunParts(const RunParts&) = delete;
  RunParts& operator=(const RunParts&) = delete;

  /// What takes the measurements: the model, or what registers them first.
  [[nodiscard]] RepresentationUpdate& representation() {
    return registered ? static_cast<RepresentationUpdate&>(*registered) : model;
  }
  /// What registration did to each view; empty without it.
  [[nodiscard]] std::vector<FrameRegistration> registrations() const {
    return registered ? registered->registrations() : std::vector<FrameRegistration>{};
  }

  RunSetup setup;
  std::shared_ptr<const Truth> truth;
  SimulatedAcquisition camera;
  MisreportedAcquisition acquisition;  ///< the camera's, at the poses that it reports
  SurfaceModel model;
  std::optional<RegisteredModel> registered;
  CandidateGeneration generation;
  PolicyDecision decision;
};

}  // namespace viewgain::app
