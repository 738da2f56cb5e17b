// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
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
             double max_range);

  /// The pose in the scene's coordinates; nothing if it is not finite or its rotation is off by
  /// more than 1e-3.
  [[nodiscard]] std::optional<PoseFrame> frame_of(const Pose& T_world_camera) const;

  /// Makes `bins` ready for tracing the view's tiles.
  void prepare(const PoseFrame& frame, TileBins& bins) const {
    if (choice_.by_lists && !frame.sees_nothing) {
      rays_->binner.sort(kernels_.isa, *scene_.scene_boxes, frame, bins);
    } else {
      bins.invalidate();
    }
  }

  /// Calls visit(tile number, RayTile) for those of the tiles with these numbers that can meet
  /// anything, in order. `bins` are prepared for the view.
  template <typename Tiles, typename Visit>
  void trace(const PoseFrame& frame, const Tiles& tiles, TileBins& bins, Visit&& visit) const {
    if (frame.sees_nothing) return;
    if (!bins.valid()) return trace_bvh(frame, tiles, visit);
    RayTile out;
    for (const std::size_t tile : tiles) {
      if (bins.boxes_of(tile).empty()) continue;
      trace_lists(frame, tile, bins, out);
      visit(tile, out);
    }
  }

  /// The same through the BVH, every tile.
  template <typename Tiles, typename Visit>
  void trace_bvh(const PoseFrame& frame, const Tiles& tiles, Visit&& visit) const {
    if (frame.sees_nothing) return;
    RTCScene bvh = scene_.tracing->bvh(choice_.margin_level);
    RayTile out;
    for (const std::size_t tile : tiles) {
      kernels_.trace(scene_, bvh, rays_->table, frame, tile, out);
      visit(tile, out);
    }
  }

  /// The numbers of all tiles.
  [[nodiscard]] auto all_tiles() const {
    return std::views::iota(std::size_t{0}, rays_->table.tile_count);
  }
  [[nodiscard]] const TileTable& table() const { return rays_->table; }

 private:
  // One tile along its list, or from cell to cell.
  void trace_lists(const PoseFrame& frame, std::size_t tile, TileBins& bins, RayTile& out) const {
    const SceneBoxes& scene = *scene_.scene_boxes;
    kernels_.begin(rays_->table, frame, tile, out);
    const float cosine = rays_->table.cosine[tile];
    if (scene.are_primitives()) {
      kernels_.walk(scene_, frame, cosine, bins.boxes_of(tile), out);
      return;
    }
    // The primitives of the next cell are chosen, and asked for, while those of this one are
    // walked.
    float of_interest = std::numeric_limits<float>::max();
    std::span<const TileBox> waiting;
    for (const TileBox& cell : bins.boxes_of(tile)) {
      if (cell.near > of_interest) break;
      const auto primitives =
          rays_->binner.select(kernels_.isa, scene, frame, cell.box, tile, of_interest, bins);
      if (primitives.empty()) continue;
      for (const TileBox& primitive : primitives) {
        __builtin_prefetch(&scene_.boxes[primitive.box]);
        if (primitive.box < scene_.leaf_count) __builtin_prefetch(&scene_.masks[primitive.box]);
      }
      if (!waiting.empty()) of_interest = kernels_.walk(scene_, frame, cosine, waiting, out);
      waiting = primitives;
      bins.keep_selected();
    }
    if (!waiting.empty()) kernels_.walk(scene_, frame, cosine, waiting, out);
  }

  const SceneData& scene_;
  const TraceKernels& kernels_;
  std::shared_ptr<const SensorRays> rays_;
  ViewChoice choice_;
  Pose T_grid_world_;
  float min_range_, max_range_;  // [voxels]
  bool is_out_of_range_;         // min_range is beyond all that is traced
};

}  // namespace viewgain::detail
