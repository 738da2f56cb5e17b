// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "scene/scene_data.hpp"
#include "scene_tracing.hpp"
#include "sensor_rays.hpp"
#include "view_sweep.hpp"
#include "viewgain/core/exec_config.hpp"

namespace viewgain::detail {

/// Traces the views of one sensor in one scene; the scene must outlive it. Which way is decided
/// by prepare(), view by view, and the bits are the same:
///
/// - by sweep: the scene's primitives from near to far, each with the rays that can meet it and
///   have not ended yet;
/// - by Embree: a BVH of the primitives, tile by tile, in packets.
///
/// Known obstacles are triangles and always traced by Embree, where they can end a ray. Known
/// surface that a ray enters before min_range ends it as an obstacle does: the sensor cannot
/// measure it, nor see through it.
/// Immutable; thread safe.
class ViewTracer {
 public:
  /// Ranges in metres. Throws Error(backend) if a BVH is wanted and cannot be built.
  ViewTracer(const SceneData& scene, std::shared_ptr<const SensorRays> rays, double min_range,
             double max_range, ExecConfig::Tracer tracer = ExecConfig::Tracer::automatic);

  /// The pose in the scene's coordinates; nothing if it is not finite or its rotation is off by
  /// more than 1e-3.
  [[nodiscard]] std::optional<PoseFrame> frame_of(const Pose& T_world_camera) const;

  /// What is asked about obstacles.
  enum class Asked : std::uint8_t {
    before_voxels,  ///< which rays end there that would end in a voxel
    along_rays,     ///< also how far rays could go on: RayTile::far
    everywhere      ///< also in tiles that meet no voxel
  };

  /// Makes `sweep` ready for tracing the view's strips, with such questions or fewer.
  void prepare(const PoseFrame& frame, ViewSweep& sweep, Asked asked = Asked::along_rays) const;

  /// Calls visit(tile number, RayTile) for those of a strip's tiles that can meet anything, in
  /// order. `sweep` is prepared for the view.
  template <Asked kAsked = Asked::before_voxels, typename Visit>
  void trace_strip(const PoseFrame& frame, TileRows strip, ViewSweep& sweep, Visit&& visit) const {
    if (frame.sees_nothing) return;
    sweep_strip(frame, strip, kAsked, sweep);
    StripRays& strip_rays = sweep.strip;
    for (std::size_t i = 0; i < strip_rays.tile_count(); ++i) {
      if (!sweep.by_bvh && !strip_rays.is_met(i)) continue;
      RayTile& rays = strip_rays.tile(i);
      finish(frame, strip_rays.first_tile() + i, sweep, rays);
      visit(strip_rays.first_tile() + i, std::as_const(rays));
    }
  }
  /// The same for all tiles of the view.
  template <Asked kAsked = Asked::before_voxels, typename Visit>
  void trace(const PoseFrame& frame, ViewSweep& sweep, Visit&& visit) const {
    // In strips whose rays stay in the near caches.
    const std::size_t rows = table().tile_rows(),
                      most = std::max<std::size_t>(kStripTiles / table().tile_columns(), 4);
    for (std::size_t begin = 0; begin < rows; begin += most) {
      trace_strip<kAsked>(frame, {begin, std::min(begin + most, rows)}, sweep, visit);
    }
  }

  /// Calls visit(tile number, RayTile) for all tiles of the view, in order, as they are before any
  /// voxel beyond min_range is looked at: only `far` is known, if anything blocks rays.
  template <typename Visit>
  void place(const PoseFrame& frame, ViewSweep& sweep, Visit&& visit) const {
    if (frame.sees_nothing) return;
    find_near(frame, sweep.near);
    RayTile rays;
    for (std::size_t tile = 0; tile < table().tile_count; ++tile) {
      begin(frame, tile, sweep.near, rays);
      if (scene_.has_obstacles) {
        ask_first(frame, rays);
      } else if (rays.blocked != 0) {
        std::copy_n(rays.range, kTileRays, rays.far);
        rays.has_far = true;
      }
      visit(tile, std::as_const(rays));
    }
  }

  [[nodiscard]] const TileTable& table() const { return rays_->table; }

 private:
  class SetUp;
  static constexpr std::size_t kStripTiles = 1600;

  void sweep_strip(const PoseFrame& frame, TileRows strip, Asked asked, ViewSweep& sweep) const;
  void find_near(const PoseFrame& frame, NearSurface& near) const;
  /// Sets a tile up: it has met nothing but surface before min_range.
  void begin(const PoseFrame& frame, std::size_t tile, const NearSurface& near,
             RayTile& rays) const {
    kernels_.begin(rays_->table, frame, tile, rays);
    near.for_each_at(tile, [&](const NearSurface::Part& part) {
      kernels_.block(scene_, frame, part.leaf, part.occupied, rays);
    });
  }
  /// What a tile's rays meet apart from what they were swept over.
  void finish(const PoseFrame& frame, std::size_t tile, const ViewSweep& sweep,
              RayTile& rays) const;
  /// Obstacles that are asked for before voxels: rays that end early have fewer to meet.
  void ask_first(const PoseFrame& frame, RayTile& rays) const;
  /// And those that are asked for behind.
  void ask_afterwards(const PoseFrame& frame, std::size_t tile, float near, RayTile& rays) const;

  const SceneData& scene_;
  const TileKernels& kernels_;
  std::shared_ptr<const SensorRays> rays_;
  ExecConfig::Tracer tracer_;
  int margin_level_;
  Pose T_grid_world_;
  float min_range_, max_range_;  // [voxels]
  bool is_out_of_range_;         // min_range is beyond all that is traced
};

}  // namespace viewgain::detail
