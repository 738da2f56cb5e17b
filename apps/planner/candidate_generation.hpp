// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "loop_exec.hpp"
#include "model.hpp"
#include "pose_sets.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/raycast/feasibility.hpp"

namespace viewgain::app {

struct GenerationConfig {
  bool boundary = true;  ///< candidates at the surface's open boundaries
  EstimatorConfig estimator{};
  double working_distance = 0;  ///< of boundary candidates from the surface [m]
  /// A boundary is classed by the last view that has it in sight past the rest of the map, not only
  /// in its image; a view is traced for that. Moves the ends of runs, and so the candidates.
  bool classes_by_sight = false;
  std::vector<PoseSet> sets{};
  FeasibilityConfig feasibility{};
};

/// A number of variants that makes a large batch: two distances, tilts of 15° to four sides, two
/// rolls; a quarter of a view overlaps with what is known; regions of 80 mm. `spacing` of the
/// surface's points [m].
[[nodiscard]] EstimatorConfig default_estimator(double spacing);

/// What every loop starts from: boundary candidates by default_estimator at the sensor's working
/// distance, no sets, feasibility for the sensor and its body, no limits of reach.
[[nodiscard]] GenerationConfig default_generation(const Sensor& sensor, double voxel_size);

/// VIEWPOINTSGENERATION of Algorithm 1: views at the open boundaries of the model's surface, and
/// fixed sets; the infeasible ones are dropped and counted by reason.
class CandidateGeneration : public ViewpointGeneration {
 public:
  CandidateGeneration(const Model& model, const Sensor& sensor, const GenerationConfig& config,
                      const LoopExec& exec);

  Proposal generate(const Pose& T_world_camera) override;

  [[nodiscard]] const GenerationConfig& config() const noexcept { return config_; }

  /// Behind the last proposal: why its boundary candidates exist. The `number` of a candidate with
  /// a class is its index in estimated().candidates, that of one of a set its index in the set.
  [[nodiscard]] const EstimatedViews& estimated() const noexcept { return estimated_; }
  /// Of the last proposal: the dropped candidates, each with its reason.
  struct Dropped {
    Candidate candidate;
    Infeasibility reason;
  };
  [[nodiscard]] const std::vector<Dropped>& dropped() const noexcept { return dropped_; }

 private:
  void estimate(std::span<const Pose> views);
  [[nodiscard]] std::vector<Candidate> all_candidates() const;

  const Model& model_;
  Sensor sensor_;
  GenerationConfig config_;
  LoopExec exec_;
  std::optional<FeasibilityChecker> checker_;  ///< of the last proposal's scene
  EstimatedViews estimated_;
  std::vector<Dropped> dropped_;
};

}  // namespace viewgain::app
