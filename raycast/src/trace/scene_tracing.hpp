// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "device.hpp"
#include "obstacle_scene.hpp"
#include "scene/brick_table.hpp"
#include "scene/pooled_surface.hpp"
#include "scene/scene_data.hpp"
#include "tile_kernels.hpp"

namespace viewgain::detail {

/// The margin by which boxes count as larger [voxels], so that rounding hides none from a ray that
/// the kernels let into it: by halvings and doublings of the coordinates that single precision has
/// to hold.
inline constexpr int kMarginLevels = 9;
/// For coordinates up to `reach` [voxels]; level 0 holds up to 2e4.
[[nodiscard]] int margin_level(double reach);
[[nodiscard]] inline float margin_of(int level) {
  return kBoxMargin * static_cast<float>(1 << level);
}

/// What a scene keeps for being traced: its kernels, obstacles, and Embree's BVH of its voxels
/// where one is wanted.
class SceneTracing {
 public:
  /// Of a scene whose primitives are gathered, which owns this; `before`: null, or the scene that
  /// it is an update of. Throws as ObstacleScene, Error(invalid_argument) as select_isa(); with
  /// obstacles Error(backend) where Embree has no packets.
  SceneTracing(const SceneData& data, const SceneData* before);

  /// The BVH of voxels, with boxes of this margin; built when first asked for. Thread safe. Throws
  /// Error(backend).
  [[nodiscard]] RTCScene bvh(int level) const;

  /// Counts a view of so many rays, and says whether to trace it by the BVH; builds that when it
  /// pays. False if it cannot be built. Thread safe.
  [[nodiscard]] bool takes_bvh(std::size_t rays, int level) const;

  /// For rays that go on through unknown voxels; built when first asked for. Thread safe. Throws
  /// Error(capacity).
  [[nodiscard]] const BrickTable& bricks() const;

  /// What is known of the surface; found when first asked for. Thread safe.
  [[nodiscard]] const PooledSurface& pooled_surface() const;

  const TileKernels& kernels;
  const std::shared_ptr<const ObstacleScene> obstacles;  ///< null: none

 private:
  struct Bvh {
    std::once_flag once;
    ScenePtr scene;
    std::atomic<bool> is_built{false}, is_wanted{false};
  };
  const SceneData& data_;
  mutable std::array<Bvh, kMarginLevels> bvhs_;
  mutable std::atomic<std::uint64_t> views_{0};  // that a BVH would have been faster for
  mutable std::once_flag bricks_once_;
  mutable std::optional<BrickTable> bricks_;
  mutable std::once_flag pooled_once_;
  mutable std::optional<PooledSurface> pooled_;
};

}  // namespace viewgain::detail
