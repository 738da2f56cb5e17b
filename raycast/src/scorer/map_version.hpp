// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/view_scorer.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

/// A map as it was at one time, and what its views are scored by. Scene, evaluator and checker are
/// made when they are first asked for, from those of an earlier version. Thread safe. All throw as
/// VoxelScene::build().
class MapVersion {
 public:
  /// The first version of a map. Makes the evaluator, to refuse settings that are not valid.
  MapVersion(const BeliefGrid& grid, const Sensor& sensor, const ScorerConfig& config,
             const ExecConfig& exec);
  /// The map as it is now, which was `before`. Costs BeliefGrid::snapshot() of what has changed.
  MapVersion(MapVersion& before, const BeliefGrid& grid);

  [[nodiscard]] std::shared_ptr<const VoxelScene> scene();
  [[nodiscard]] std::shared_ptr<const GainEvaluator> evaluator();
  /// Null if the sensor has no body.
  [[nodiscard]] std::shared_ptr<const FeasibilityChecker> checker();

 private:
  /// What was made last, of this version or of an earlier one.
  struct Made {
    std::shared_ptr<const VoxelScene> scene;
    std::shared_ptr<const GainEvaluator> evaluator;
    std::shared_ptr<const FeasibilityChecker> checker;
  };

  [[nodiscard]] const std::shared_ptr<const VoxelScene>& own_scene();

  std::mutex mutex_;
  ExecConfig exec_;
  std::optional<GridSnapshot> snapshot_;  ///< until the scene is made of it
  Made made_;
};

}  // namespace viewgain::detail
