// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::app {

/// A fixed set of poses with a name: sphere, dome, rings, sequence, file.
struct PoseSet {
  std::string generator;
  std::vector<Pose> poses;  ///< T_world_camera
};

struct GenerationConfig {
  bool boundary = true;  ///< candidates at the surface's open boundaries
  EstimatorConfig estimator{};
  double working_distance = 0;  ///< of boundary candidates from the surface [m]
  std::vector<PoseSet> sets{};
  FeasibilityConfig feasibility{};
};

/// VIEWPOINTSGENERATION of Algorithm 1: views at the open boundaries of the model's surface, and
/// fixed sets; the infeasible ones are dropped and counted by reason.
class CandidateGeneration : public ViewpointGeneration {
 public:
  CandidateGeneration(const Model& model, const Sensor& sensor, const GenerationConfig& config,
                      const ExecConfig& exec, StageSeconds& seconds);

  Proposal generate(const Pose& T_world_camera) override;

  /// Behind the last proposal: why its boundary candidates exist. A candidate's `source` is the
  /// index of its patch.
  [[nodiscard]] const EstimatedViews& estimated() const noexcept { return estimated_; }
  /// Of the last proposal: the dropped candidates, each with its reason.
  struct Dropped {
    Candidate candidate;
    Infeasibility reason;
  };
  [[nodiscard]] const std::vector<Dropped>& dropped() const noexcept { return dropped_; }

 private:
  const Model& model_;
  Sensor sensor_;
  GenerationConfig config_;
  ExecConfig exec_;
  std::optional<FeasibilityChecker> checker_;  ///< of the last proposal's scene
  StageSeconds& seconds_;
  EstimatedViews estimated_;
  std::vector<Dropped> dropped_;
};

}  // namespace viewgain::app
