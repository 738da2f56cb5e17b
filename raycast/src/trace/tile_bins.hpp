// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "image_bounds.hpp"
#include "ray_tile.hpp"
#include "scene/scene_boxes.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/isa.hpp"

namespace viewgain::detail {

class ObstacleScene;

/// Something that a tile's rays can meet.
struct TileBox {
  std::uint32_t box;  ///< or primitive
  float near;  ///< neither this nor any later one of a list begins nearer, along the optical axis
};

/// The tiles of a view and the boxes that each can meet, near ones first. Where boxes stand for
/// many primitives, those of a box are projected when the first tile asks for them.
class TileBins {
 public:
  /// False if nothing is sorted: views then go through the BVH.
  [[nodiscard]] bool valid() const { return valid_; }
  void invalidate() {
    valid_ = false;
    obstacle_near_.clear();
  }
  [[nodiscard]] std::span<const TileBox> boxes_of(std::size_t tile) const {
    return {boxes_.data() + starts_[tile], boxes_.data() + starts_[tile + 1]};
  }
  /// How far along the optical axis an obstacle may begin that a tile's rays meet [voxels]; no
  /// obstacle: kNoObstacle.
  [[nodiscard]] float obstacle_near(std::size_t tile) const {
    return obstacle_near_.empty() ? kNoObstacle : obstacle_near_[tile];
  }
  static constexpr float kNoObstacle = std::numeric_limits<float>::infinity();
  /// There may be obstacles anywhere.
  void expect_obstacles(std::size_t tiles) {
    obstacle_near_.assign(tiles, 0.0F);
    farthest_voxel_ = kNoObstacle;
  }
  /// No voxel of the workspace is farther along the axis [voxels]; known where obstacles are.
  [[nodiscard]] float farthest_voxel() const { return farthest_voxel_; }
  /// Leaves what TileBinner::select() returned last as it is until this is called again.
  void keep_selected() { std::swap(selected_, kept_); }

 private:
  friend class TileBinner;
  struct Entry {
    std::uint32_t box;
    float near;
    std::uint16_t column0, column1, row0, row1;
  };
  // The members of a cell, seen from the pose of this generation: tiles that each covers.
  struct Cell {
    std::uint32_t generation = 0;
    std::uint32_t begin = 0, end = 0;  // in the arrays below, whole vectors
  };
  bool valid_ = false;
  std::vector<std::uint32_t> starts_;
  std::vector<std::int32_t> differences_;
  std::vector<TileBox> boxes_;
  std::vector<Entry> entries_, sorted_;
  std::uint32_t generation_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::int16_t> column0_, column1_, row0_, row1_;
  std::vector<TileBox> member_;  // primitives
  std::vector<TileBox> selected_, kept_;
  std::vector<float> obstacle_near_;  // one a tile; empty: there are none
  float farthest_voxel_ = 0;
};

/// Sorts a scene's boxes into the tiles of a view by their outlines in the image. About half of a
/// view's rays usually pass the object, and of the rest each meets few boxes; projecting all boxes
/// once tells that for less than walking a BVH tile by tile. Conservative: no box that a tile's
/// rays can meet at or beyond the least range is missing.
class TileBinner {
 public:
  TileBinner(const PinholeCamera& camera, int pixel_stride, const TileTable& table);

  /// Fills `bins`; allocates only while they grow. Thread safe.
  void sort(Isa isa, const SceneBoxes& boxes, const PoseFrame& frame, TileBins& bins) const;

  /// Notes in `bins` where in the image obstacles may be, which count from the camera on; what lies
  /// behind all voxels may be left out. Thread safe.
  void mark_obstacles(Isa isa, const ObstacleScene& obstacles, const PoseFrame& frame,
                      bool only_before_voxels, TileBins& bins) const;

  /// The primitives of a cell (a box of sorted boxes that stands for many) that a tile's rays can
  /// meet and that begin no farther than `of_interest` along the axis, near ones first. Valid until
  /// the next call.
  [[nodiscard]] std::span<const TileBox> select(Isa isa, const SceneBoxes& boxes,
                                                const PoseFrame& frame, std::uint32_t cell,
                                                std::size_t tile, float of_interest,
                                                TileBins& bins) const;

 private:
  void project_cell(const ImageBoundsKernels& kernels, const SceneBoxes& scene,
                    const PoseFrame& frame, std::uint32_t cell, TileBins& bins) const;
  [[nodiscard]] ImageScale image_of(const PoseFrame& frame, float min_range) const;

  LensBend lens_;
  float scale_x_ = 0, shift_x_ = 0;  // ray column = scale * x / z + shift, the lens apart
  float scale_y_ = 0, shift_y_ = 0;
  float last_column_ = 0, last_row_ = 0;
  float least_cosine_ = 1;  // of a ray with the optical axis
  float widest_slope_ = 0;  // of a ray to the optical axis, or more
  std::size_t tile_columns_ = 0, tile_count_ = 0;
};

}  // namespace viewgain::detail
