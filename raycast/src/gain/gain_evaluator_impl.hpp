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
