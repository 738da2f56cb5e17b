// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <mutex>
#include <optional>

#include "device.hpp"
#include "leaf_traversal.hpp"
#include "scene/brick_table.hpp"
#include "scene/scene_data.hpp"
#include "trace_choice.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain::detail {

/// What a scene keeps for being traced: its kernels, and Embree's BVH where one is wanted.
class SceneTracing {
 public:
  /// Of a scene whose primitives are gathered, which owns this.
  explicit SceneTracing(const SceneData& data)
      : kernels(trace_kernels(choose_isa())), data_(data) {}

  /// The BVH with boxes of this margin; built when first asked for. Thread safe. Throws
  /// Error(backend), Error(capacity).
  [[nodiscard]] RTCScene bvh(int margin_level) const;

  /// Obstacles alone; the scene has some. As bvh().
  [[nodiscard]] RTCScene obstacle_bvh() const;

  /// Of the scene's unknown voxels; found when first asked for. Thread safe.
  [[nodiscard]] const HazardField& hazard() const;

  /// For rays that go on through unknown voxels; built when first asked for. Thread safe. Throws
  /// Error(capacity).
  [[nodiscard]] const BrickTable& bricks() const;

  const TraceKernels& kernels;

 private:
  struct Bvh {
    std::once_flag once;
    ScenePtr scene;
  };
  const SceneData& data_;
  mutable std::array<Bvh, kMarginLevels> bvhs_;
  mutable Bvh obstacles_;
  mutable std::once_flag hazard_once_;
  mutable std::optional<HazardField> hazard_;
  mutable std::once_flag bricks_once_;
  mutable std::optional<BrickTable> bricks_;
};

}  // namespace viewgain::detail
