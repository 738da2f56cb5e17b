// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include "device.hpp"
#include "leaf_traversal.hpp"
#include "obstacle_scene.hpp"
#include "scene/brick_table.hpp"
#include "scene/scene_data.hpp"
#include "trace_choice.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain::detail {

/// What a scene keeps for being traced: its kernels, obstacles, and Embree's BVH of its voxels
/// where one is wanted.
class SceneTracing {
 public:
  /// Of a scene whose primitives are gathered, which owns this; `before`: null, or the scene that
  /// it is an update of. Throws as ObstacleScene.
  SceneTracing(const SceneData& data, const SceneData* before)
      : kernels(trace_kernels(choose_isa())),
        obstacles(ObstacleScene::of(data, kernels.isa, before)),
        data_(data) {}

  /// The BVH of voxels, with boxes of this margin; built when first asked for. Thread safe. Throws
  /// Error(backend), Error(capacity).
  [[nodiscard]] RTCScene bvh(int margin_level) const;

  /// Of the scene's unknown voxels; found when first asked for. Thread safe.
  [[nodiscard]] const HazardField& hazard() const;

  /// For rays that go on through unknown voxels; built when first asked for. Thread safe. Throws
  /// Error(capacity).
  [[nodiscard]] const BrickTable& bricks() const;

  const TraceKernels& kernels;
  const std::shared_ptr<const ObstacleScene> obstacles;  ///< null: none

 private:
  struct Bvh {
    std::once_flag once;
    ScenePtr scene;
  };
  const SceneData& data_;
  mutable std::array<Bvh, kMarginLevels> bvhs_;
  mutable std::once_flag hazard_once_;
  mutable std::optional<HazardField> hazard_;
  mutable std::once_flag bricks_once_;
  mutable std::optional<BrickTable> bricks_;
};

}  // namespace viewgain::detail
