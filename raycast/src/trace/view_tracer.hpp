// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <ranges>

#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "tile_bins.hpp"

namespace viewgain::detail {

/// Traces the views of one sensor in one scene. There are two ways, which give the same bits:
/// through Embree's BVH, and, where the camera has no distortion and the scene no obstacles, along
/// lists of the primitives that each tile can meet. Immutable; thread safe.
class ViewTracer {
 public:
  ViewTracer(const VoxelScene::Data& scene, const PinholeCamera& camera, int pixel_stride,
             double min_range, double max_range);

  /// The pose in the scene's coordinates; nothing if it is not finite or its rotation is off by
  /// more than 1e-3.
  [[nodiscard]] std::optional<PoseFrame> frame_of(const Pose& T_world_camera) const;

  /// Calls visit(tile number, RayTile) for the tiles that can meet anything, in order.
  template <typename Visit>
  void trace(const PoseFrame& frame, TileBins& bins, Visit&& visit) const {
    prepare(frame, bins);
    trace_some(frame, 0, table_.tile_count, bins, visit);
  }

  /// Makes `bins` ready for trace_some().
  void prepare(const PoseFrame& frame, TileBins& bins) const {
    if (frame.sees_nothing || scene_.has_obstacles) {
      bins.invalidate();
    } else {
      sort(frame, bins);
    }
  }

  /// As trace(), of the tiles [begin, end).
  template <typename Visit>
  void trace_some(const PoseFrame& frame, std::size_t begin, std::size_t end, TileBins& bins,
                  Visit&& visit) const {
    trace_listed(frame, std::views::iota(begin, end), bins, visit);
  }

  /// As trace(), of the tiles with these numbers.
  template <typename Tiles, typename Visit>
  void trace_listed(const PoseFrame& frame, const Tiles& tiles, TileBins& bins,
                    Visit&& visit) const {
    if (frame.sees_nothing) return;
    RayTile out;
    for (const std::size_t tile : tiles) {
      if (!bins.valid()) {
        scene_.kernels->trace(scene_, table_, frame, tile, out);
      } else if (bins.boxes_of(tile).empty()) {
        continue;
      } else {
        trace_tile(frame, tile, bins, out);
      }
      visit(tile, out);
    }
  }

  /// Sorts the scene's boxes into the tiles; only if bins.valid() is then true may trace_tile() be
  /// called.
  void sort(const PoseFrame& frame, TileBins& bins) const {
    binner_.sort(scene_.kernels->isa, *scene_.scene_boxes, frame, bins);
  }

  /// One tile whose boxes have been sorted.
  void trace_tile(const PoseFrame& frame, std::size_t tile, TileBins& bins, RayTile& out) const {
    const SceneBoxes& scene = *scene_.scene_boxes;
    const TraceKernels& kernels = *scene_.kernels;
    kernels.begin(table_, frame, tile, out);
    const float cosine = table_.cosine[tile];
    if (scene.are_primitives()) {
      kernels.walk(scene_, frame, cosine, bins.boxes_of(tile), out);
      return;
    }
    // The primitives of the next cell are chosen, and asked for, while those of this one are
    // walked.
    float of_interest = std::numeric_limits<float>::max();
    std::span<const TileBox> waiting;
    for (const TileBox& cell : bins.boxes_of(tile)) {
      if (cell.near > of_interest) break;
      const auto primitives =
          binner_.select(kernels.isa, scene, frame, cell.box, tile, of_interest, bins);
      if (primitives.empty()) continue;
      for (const TileBox& primitive : primitives) {
        __builtin_prefetch(&scene_.boxes[primitive.box]);
        if (primitive.box < scene_.leaf_count) __builtin_prefetch(&scene_.masks[primitive.box]);
      }
      if (!waiting.empty()) of_interest = kernels.walk(scene_, frame, cosine, waiting, out);
      waiting = primitives;
      bins.keep_selected();
    }
    if (!waiting.empty()) kernels.walk(scene_, frame, cosine, waiting, out);
  }

  /// The same through the BVH alone, every tile, which the evaluator does not do where it need not.
  template <typename Visit>
  void trace_bvh(const PoseFrame& frame, Visit&& visit) const {
    scene_.ensure_bvh();
    if (frame.sees_nothing) return;
    RayTile out;
    for (std::size_t tile = 0; tile < table_.tile_count; ++tile) {
      scene_.kernels->trace(scene_, table_, frame, tile, out);
      visit(tile, out);
    }
  }

  [[nodiscard]] const TileTable& table() const { return table_; }

 private:
  const VoxelScene::Data& scene_;
  TileTable table_;
  TileBinner binner_;
  Pose T_grid_world_;
  double min_range_, max_range_;  // [m]
};

}  // namespace viewgain::detail
