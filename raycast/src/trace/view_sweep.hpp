// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cell_sweep.hpp"
#include "image_bounds.hpp"
#include "obstacle_scene.hpp"
#include "ray_tile.hpp"
#include "scene/scene_cells.hpp"
#include "scene/scene_data.hpp"
#include "strip_rays.hpp"

namespace viewgain::detail {

/// Where in the image of a view obstacles may be.
class ObstacleMarks {
 public:
  static constexpr float kNoObstacle = std::numeric_limits<float>::infinity();

  /// There are none.
  void clear() { near_.clear(); }
  /// There may be some anywhere.
  void expect(std::size_t tiles) {
    near_.assign(tiles, 0.0F);
    farthest_voxel_ = kNoObstacle;
  }
  /// Looks where they are; `image` counts rays from the camera on. What lies behind all voxels may
  /// be left out.
  void mark(const ImageBoundsKernels& kernels, const ObstacleScene& obstacles,
            const PoseFrame& frame, const ImageScale& image, const TileTable& table,
            bool only_before_voxels);

  /// How far along the optical axis an obstacle may begin that a tile's rays meet [voxels]; no
  /// obstacle: kNoObstacle.
  [[nodiscard]] float near(std::size_t tile) const {
    return near_.empty() ? kNoObstacle : near_[tile];
  }
  /// No voxel of the workspace is farther along the axis [voxels]; known where obstacles are.
  [[nodiscard]] float farthest_voxel() const { return farthest_voxel_; }

 private:
  std::vector<float> near_;  // one a tile; empty: there are none
  float farthest_voxel_ = 0;
};

/// The known surface within min_range of a view's camera: no reading comes from there, but rays
/// end.
class NearSurface {
 public:
  /// Occupied voxels of a leaf, and the tiles whose rays can meet them.
  struct Part {
    std::uint32_t leaf;
    std::uint32_t column0, column1, row0, row1;
    TraceMask occupied;
  };

  void clear() { parts_.clear(); }
  /// Finds it; `image` counts rays from the camera on. The camera's own voxel is left out: whether
  /// a view from there counts is for others to say. Allocates only while it grows.
  void find(const ImageBoundsKernels& kernels, const SceneData& scene, const PoseFrame& frame,
            const ImageScale& image, const TileTable& table);

  /// Calls visit(part) for those that a tile's rays can meet.
  template <typename Visit>
  void for_each_at(std::size_t tile, Visit&& visit) const {
    if (parts_.empty()) return;
    const std::size_t row = tile / tile_columns_, column = tile % tile_columns_;
    for (const Part& part : parts_) {
      if (row >= part.row0 && row <= part.row1 && column >= part.column0 &&
          column <= part.column1) {
        visit(part);
      }
    }
  }

 private:
  std::vector<Part> parts_;
  std::size_t tile_columns_ = 1;
};

/// What a thread needs to sweep views of any scene and sensor, one after another.
struct ViewSweep {
  std::vector<SeenCell> seen;  ///< cells that reach out of their nodes, then from near to far
  std::array<std::int32_t, 3> camera_block{};  ///< on the lattice of 8³ voxels
  ObstacleMarks obstacles;
  NearSurface near;
  StripRays strip;
  bool by_bvh = false;  ///< Embree traces the view instead

  /// Finds the cells that a view sees. Allocates only while it grows.
  void see(const ImageBoundsKernels& kernels, const SceneCells& cells, const PoseFrame& frame,
           const ImageScale& image);

 private:
  std::vector<SeenCell> found_;
  std::vector<std::uint32_t> keys_, begins_;
};

}  // namespace viewgain::detail
