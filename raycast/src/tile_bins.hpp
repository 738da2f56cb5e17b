// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ray_tile.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/isa.hpp"

namespace viewgain::detail {

struct PrimitiveBox;

/// Boxes that together hold everything in a scene that is not free, as centres and half edges
/// [voxels], padded to whole vectors.
struct SceneBoxes {
  std::vector<float> center_x, center_y, center_z, half_x, half_y, half_z;
  std::size_t count = 0;
  bool are_primitives = false;  ///< box i is primitive i; else each stands for many

  /// One box a primitive, or, where there are more than kMaxBoxes, one for each cell of a grid that
  /// is coarse enough.
  explicit SceneBoxes(const std::vector<PrimitiveBox>& primitives);

  static constexpr std::size_t kMaxBoxes = 4096;
};

/// The tiles of a view and the boxes that each can meet, near ones first.
class TileBins {
 public:
  /// False if the boxes could not be projected; then nothing is known of any tile.
  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] std::span<const std::uint32_t> boxes_of(std::size_t tile) const {
    return {boxes_.data() + starts_[tile], boxes_.data() + starts_[tile + 1]};
  }

 private:
  friend class TileBinner;
  struct Entry {
    std::uint32_t box;
    float distance;
    std::uint16_t column0, column1, row0, row1;
  };
  bool valid_ = false;
  std::vector<std::uint32_t> starts_, boxes_;
  std::vector<Entry> entries_, sorted_;
};

/// Sorts a scene's boxes into the tiles of a view by their outlines in the image. About half of a
/// view's rays usually pass the object, and of the rest each meets few boxes; projecting all boxes
/// once tells that for less than walking a BVH tile by tile, as long as there are not too many. For
/// cameras without distortion. Conservative: no box that a tile's rays can meet is missing.
class TileBinner {
 public:
  TileBinner(const PinholeCamera& camera, int pixel_stride, const TileTable& table);

  /// Fills `bins`; allocates only while they grow. Thread safe.
  void sort(Isa isa, const SceneBoxes& boxes, const PoseFrame& frame, TileBins& bins) const;

 private:
  bool usable_ = true;
  float scale_x_ = 0, shift_x_ = 0;  // ray column = scale * x / z + shift
  float scale_y_ = 0, shift_y_ = 0;
  float last_column_ = 0, last_row_ = 0;
  std::size_t tile_columns_ = 0, tile_count_ = 0;
};

}  // namespace viewgain::detail
