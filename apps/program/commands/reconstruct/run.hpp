// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "program/cli/json.hpp"
#include "program/commands/reconstruct/run_options.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/pose_noise.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner/simulated_acquisition.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/policies.hpp"
#include "viewgain/planner_mesh/registered_model.hpp"
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

/// The parts of a simulated run, wired up as its flags say. For one run.
class Run {
 public:
  /// Finds which samples of the mesh are visible, which takes some tenths of a second. Throws
  /// Error.
  Run(RunSetup setup, std::size_t frames_per_view, const ExecConfig& exec);
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// The loop, to its end; `observer` is called once a view, when its record is complete.
  PlanningResult go(const std::function<void(const ViewRecord&)>& observer);

  [[nodiscard]] const RunSetup& setup() const noexcept { return setup_; }
  [[nodiscard]] const std::shared_ptr<const Truth>& truth() const noexcept { return truth_; }
  [[nodiscard]] const SimulatedAcquisition& acquisition() const noexcept { return acquisition_; }
  /// What registration did to each view; empty without it.
  [[nodiscard]] std::vector<FrameRegistration> registrations() const {
    return registered_ ? registered_->registrations() : std::vector<FrameRegistration>{};
  }
  [[nodiscard]] const SurfaceModel& model() const noexcept { return model_; }
  [[nodiscard]] const CandidateGeneration& generation() const noexcept { return generation_; }
  [[nodiscard]] CandidateGeneration& generation() noexcept { return generation_; }

 private:
  RunSetup setup_;
  std::shared_ptr<const Truth> truth_;
  SimulatedAcquisition acquisition_;
  MisreportedAcquisition reported_;
  SurfaceModel model_;
  std::optional<RegisteredModel> registered_;
  CandidateGeneration generation_;
  PolicyDecision decision_;
};

}  // namespace viewgain::app
