// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scorer/map_version.hpp"

#include <algorithm>
#include <utility>

namespace viewgain::detail {

MapVersion::MapVersion(const BeliefGrid& grid, const Sensor& sensor, const ScorerConfig& config,
                       const ExecConfig& exec)
    : exec_(exec) {
  made_.scene = VoxelScene::build(grid, config.surroundings(), exec, config.hazard);
  made_.evaluator = std::make_shared<const GainEvaluator>(made_.scene, sensor, config.gain, exec);
  if (!sensor.body_size) return;
  FeasibilityConfig feasibility = feasibility_of(sensor);
  feasibility.clearance = config.clearance;
  made_.checker = std::make_shared<const FeasibilityChecker>(made_.scene, feasibility, exec);
}

MapVersion::MapVersion(MapVersion& before, const BeliefGrid& grid) : exec_(before.exec_) {
  const std::lock_guard lock(before.mutex_);
  made_ = before.made_;
  if (!before.snapshot_) {
    snapshot_ = grid.snapshot(made_.scene->snapshot());
    return;
  }
  snapshot_ = grid.snapshot(*before.snapshot_);
  // Data shared with the scene that was made last, which can be older.
  snapshot_->shared_until = std::min(snapshot_->shared_until, before.snapshot_->shared_until);
}

const std::shared_ptr<const VoxelScene>& MapVersion::own_scene() {
  if (snapshot_) {
    made_.scene = VoxelScene::update(made_.scene, *snapshot_, exec_);
    snapshot_.reset();
  }
  return made_.scene;
}

std::shared_ptr<const VoxelScene> MapVersion::scene() {
  const std::lock_guard lock(mutex_);
  return own_scene();
}

HazardProbe MapVersion::hazard_probe(const HazardConfig& config) {
  const std::lock_guard lock(mutex_);
  return HazardProbe(snapshot_ ? *snapshot_ : made_.scene->snapshot(), config);
}

std::shared_ptr<const GainEvaluator> MapVersion::evaluator() {
  const std::lock_guard lock(mutex_);
  const auto& scene = own_scene();
  if (&made_.evaluator->scene() != scene.get()) {
    made_.evaluator = std::make_shared<const GainEvaluator>(made_.evaluator->with_scene(scene));
  }
  return made_.evaluator;
}

std::shared_ptr<const FeasibilityChecker> MapVersion::checker() {
  const std::lock_guard lock(mutex_);
  if (made_.checker && &made_.checker->scene() != own_scene().get()) {
    made_.checker =
        std::make_shared<const FeasibilityChecker>(made_.checker->with_scene(made_.scene));
  }
  return made_.checker;
}

}  // namespace viewgain::detail
