// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rays_left.hpp"

namespace viewgain::detail {

/// Makes tiles when they are first met.
class TileMaker {
 public:
  TileMaker() = default;
  TileMaker(const TileMaker&) = delete;
  TileMaker& operator=(const TileMaker&) = delete;
  /// `near`: neither this nor any other primitive that is still to come begins much nearer, along
  /// the optical axis [voxels].
  virtual void make(std::size_t tile, float near, RayTile& out) const = 0;

 protected:
  ~TileMaker() = default;
};

/// The rays of a strip of the image, which of them have not ended, and where the others have.
///
/// They are kept by tiles, for who takes them in the end; a tile is made when a primitive first
/// meets it. Where primitives are small in the image their tiles' directions and ends are also kept
/// row by row: what such a primitive can end fits in one window of 4×4 rays that begins anywhere,
/// but lies in four tiles as often as not. Windows may reach beyond the strip.
///
/// Serves strips of any image, one after another; allocates only while it grows.
class StripRays {
 public:
  /// Goes over to another strip, of which no tile has been met. The maker must outlive its use.
  void begin(const TileTable& table, TileRows strip, const TileMaker& maker);

  /// Makes rows of the image rows of the strip; false: no part of the rectangle is in the strip.
  [[nodiscard]] bool clip(ImageRect& rect) const {
    rect.row0 = std::max(rect.row0, first_row_) - first_row_;
    rect.row1 = std::min(rect.row1, last_row_) - first_row_;
    return rect.row0 <= rect.row1;
  }
  [[nodiscard]] const RaysLeft& left() const { return left_; }
  [[nodiscard]] std::span<const RaysLeft::TileLanes> left_in(const ImageRect& rect) {
    return left_.in(rect);
  }

  // By tiles.

  [[nodiscard]] std::size_t first_tile() const { return first_tile_; }
  [[nodiscard]] std::size_t tile_count() const { return state_.size(); }
  /// Tile i, which has been met.
  [[nodiscard]] RayTile& tile(std::size_t i) { return tiles_[i]; }
  [[nodiscard]] bool is_met(std::size_t i) const { return state_[i] != State::not_met; }
  /// Tile i is met by something that begins there.
  RayTile& meet(std::size_t i, float near) {
    if (!is_met(i)) make(i, near);
    return tiles_[i];
  }
  /// Some rays of tile i end where it says by now; `is_final`: nothing nearer will follow.
  void end_in_tile(std::size_t i, std::uint32_t lanes, bool is_final) {
    if (lanes == 0) return;
    tiles_[i].hit |= lanes;
    const bool by_rows = state_[i] == State::by_rows;
    if (is_final) {
      left_.take(i, lanes);
      if (by_rows) left_.copy_to_rows(i);
    } else if (by_rows) {
      copy_ends(i);
    }
  }

  // By rows.

  /// The tiles of a rectangle that have rays left are met, and kept by rows from now on.
  void meet_by_rows(const ImageRect& rect, float near);
  /// Where a ray, or the first of a row of a window, lies in the arrays below.
  [[nodiscard]] std::size_t place(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row) * pitch_ + static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::size_t pitch() const { return pitch_; }
  [[nodiscard]] const float* direction(std::size_t axis) const { return rows_[axis].data(); }
  [[nodiscard]] const float* inverse(std::size_t axis) const { return rows_[3 + axis].data(); }
  [[nodiscard]] const float* range() const { return rows_[6].data(); }
  [[nodiscard]] const std::uint32_t* primitive() const { return primitive_.data(); }
  /// A ray ends in a voxel; is_final as above.
  void end(std::int32_t row, std::int32_t column, float range, std::uint32_t primitive,
           std::uint32_t offset, bool is_final) {
    const auto y = static_cast<std::uint32_t>(row), x = static_cast<std::uint32_t>(column);
    const std::size_t tile = y / kTileEdge * tile_columns_ + x / kTileEdge;
    const std::uint32_t lane = y % kTileEdge * kTileEdge + x % kTileEdge;
    RayTile& out = tiles_[tile];
    out.range[lane] = range;
    out.primitive[lane] = primitive;
    out.offset[lane] = offset;
    out.hit |= 1U << lane;
    if (is_final) {
      left_.take(tile, 1U << lane);
      left_.take_from_rows(y, x);
    } else {
      const std::size_t at = place(row, column);
      rows_[6][at] = range;
      primitive_[at] = primitive;
    }
  }

 private:
  enum class State : std::uint8_t { not_met, met, by_rows };

  void make(std::size_t i, float near);
  // From a tile to the rows: all, or where its rays end.
  void copy_to_rows(std::size_t i);
  void copy_ends(std::size_t i);
  // Of a tile's first ray.
  [[nodiscard]] std::size_t place_of(std::size_t i) const {
    return i / tile_columns_ * kTileEdge * pitch_ + i % tile_columns_ * kTileEdge;
  }

  std::size_t first_tile_ = 0, tile_columns_ = 0;
  std::int32_t first_row_ = 0, last_row_ = 0;  // of the image
  const TileMaker* maker_ = nullptr;
  RaysLeft left_;
  std::vector<RayTile> tiles_;
  std::vector<State> state_;
  std::size_t pitch_ = 0, row_count_ = 0;
  std::array<std::vector<float>, 7> rows_;  // directions, inverses, ranges
  std::vector<std::uint32_t> primitive_;
};

}  // namespace viewgain::detail
