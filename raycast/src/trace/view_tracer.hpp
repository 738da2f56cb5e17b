// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <ranges>

#include "scene/scene_data.hpp"
#include "scene_tracing.hpp"
#include "sensor_rays.hpp"
#include "trace_choice.hpp"

namespace viewgain::detail {

/// Traces the views of one sensor in one scene, one way or the other (trace_choice.hpp); the scene
/// must outlive it. Immutable; thread safe.
class ViewTracer {
 public:
  /// Ranges in metres. Throws Error(backend), Error(capacity) if a BVH is wanted and cannot be
  /// built.
  ViewTracer(const SceneData& scene, std::shared_ptr<const SensorRays> rays, double min_range,
             double max_range, TraceWay way = TraceWay::lists);

  /// The pose in the scene's coordinates; nothing if it is not finite or its rotation is off by
  /// more than 1e-3.
  [[nodiscard]] std::optional<PoseFrame> frame_of(const Pose& T_world_camera) const;

  /// What is asked about obstacles.
  enum class Asked : std::uint8_t {
    before_voxels,  ///< which rays end there that would end in a voxel
    along_rays,     ///< also how far rays could go on: RayTile::far
    everywhere      ///< also in tiles that meet no voxel
  };

  /// Makes `bins` ready for tracing the view's tiles, with such questions or fewer.
  void prepare(const PoseFrame& frame, TileBins& bins, Asked asked = Asked::along_rays) const;

  /// Calls visit(tile number, RayTile) for those of the tiles with these numbers that can meet
  /// anything, in order. `bins` are prepared for the view.
  template <Asked kAsked = Asked::before_voxels, typename Tiles, typename Visit>
  void trace(const PoseFrame& frame, const Tiles& tiles, TileBins& bins, Visit&& visit) const {
    if (frame.sees_nothing) return;
    RayTile out;
    for (const std::size_t tile : tiles) {
      const bool meets = !bins.valid() || !bins.boxes_of(tile).empty();
      if (!meets &&
          (kAsked != Asked::everywhere || bins.obstacle_near(tile) == TileBins::kNoObstacle)) {
        continue;
      }
      kernels_.begin(rays_->table, frame, tile, out);
      if (bins.obstacle_near(tile) == TileBins::kNoObstacle) {
        trace_voxels(frame, tile, bins, out);
      } else {
        trace_with_obstacles(frame, tile, kAsked, bins, out);
      }
      visit(tile, out);
    }
  }

  /// The numbers of all tiles.
  [[nodiscard]] auto all_tiles() const {
    return std::views::iota(std::size_t{0}, rays_->table.tile_count);
  }
  [[nodiscard]] const TileTable& table() const { return rays_->table; }

 private:
  // One tile that has been set up.
  void trace_voxels(const PoseFrame& frame, std::size_t tile, TileBins& bins, RayTile& out) const;
  void trace_lists(const PoseFrame& frame, std::size_t tile, TileBins& bins, RayTile& out) const;
  void trace_with_obstacles(const PoseFrame& frame, std::size_t tile, Asked asked, TileBins& bins,
                            RayTile& out) const;

  const SceneData& scene_;
  const TraceKernels& kernels_;
  std::shared_ptr<const SensorRays> rays_;
  ViewChoice choice_;
  Pose T_grid_world_;
  float min_range_, max_range_;  // [voxels]
  bool is_out_of_range_;         // min_range is beyond all that is traced
};

}  // namespace viewgain::detail
