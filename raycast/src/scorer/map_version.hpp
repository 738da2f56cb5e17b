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

/// One version of a map, with its scene, evaluator and checker. These are made on the first call,
/// from those of an earlier version. Thread safe. All members throw like VoxelScene::build().
class MapVersion {
 public:
  /// The first version of a map. Makes the evaluator, to check the settings.
  MapVersion(const BeliefGrid& grid, const Sensor& sensor, const ScorerConfig& config,
             const ExecConfig& exec);
  /// The current version of a map whose previous version is `before`. Cost: BeliefGrid::snapshot()
  /// of the changed parts.
  MapVersion(MapVersion& before, const BeliefGrid& grid);

  [[nodiscard]] std::shared_ptr<const VoxelScene> scene();
  [[nodiscard]] std::shared_ptr<const GainEvaluator> evaluator();
  /// The scene's hazard at single voxels, without making the scene.
  [[nodiscard]] HazardProbe hazard_probe(const HazardConfig& config);
  /// Null if the sensor has no body.
  [[nodiscard]] std::shared_ptr<const FeasibilityChecker> checker();

 private:
  /// The latest existing objects, of this or an earlier version.
  struct Made {
    std::shared_ptr<const VoxelScene> scene;
    std::shared_ptr<const GainEvaluator> evaluator;
    std::shared_ptr<const FeasibilityChecker> checker;
  };

  [[nodiscard]] const std::shared_ptr<const VoxelScene>& own_scene();

  std::mutex mutex_;
  ExecConfig exec_;
  std::optional<GridSnapshot> snapshot_;  ///< until the scene is made from it
  Made made_;
};

}  // namespace viewgain::detail
