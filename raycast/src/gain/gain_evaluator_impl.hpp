// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "view_driver.hpp"

namespace viewgain {

namespace detail {

/// What a lane ends in, which must be one that is hit or blocked.
[[nodiscard]] inline RayHit::Kind kind_of_end(const SceneData& scene, const RayTile& tile,
                                              int lane) {
  if ((tile.blocked >> lane & 1U) != 0) return RayHit::Kind::obstacle;
  return scene.occupied_leaf(tile.primitive[lane], tile.offset[lane]) != nullptr
             ? RayHit::Kind::occupied
             : RayHit::Kind::unknown;
}

/// As ViewDriver::evaluate(), the same bits, with all threads at one view.
[[nodiscard]] ViewGain evaluate_together(const ViewDriver& driver, const Pose& T_world_camera);

/// What a measure of the user's own says of a view: NaN for a bad pose, 0 for a camera in an
/// occupied voxel, of which it is not asked. Throws what the measure throws.
[[nodiscard]] double measured(const ViewDriver& driver, const Pose& T_world_camera,
                              ViewDriver::Lease& lease, const ViewMeasure& measure);
[[nodiscard]] double measured(const ViewDriver& driver, const Pose& T_world_camera,
                              ViewDriver::Lease& lease, const RunMeasure& measure);

}  // namespace detail

struct GainEvaluator::Impl {
  std::shared_ptr<const VoxelScene> scene;
  detail::ViewDriver driver;

  Impl(std::shared_ptr<const VoxelScene> s, std::shared_ptr<detail::EvaluatorCore> core)
      : scene(std::move(s)), driver(*scene, std::move(core)) {}
};

namespace detail {

/// The way into an evaluator for this module.
struct EvaluatorAccess {
  [[nodiscard]] static const ViewDriver& driver(const GainEvaluator& evaluator) {
    return evaluator.impl_->driver;
  }
};

}  // namespace detail

}  // namespace viewgain
