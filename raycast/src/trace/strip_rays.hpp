// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "image_bounds.hpp"
#include "ray_tile.hpp"

namespace viewgain::detail {

/// Some rows of the tiles of an image.
struct TileRows {
  std::size_t begin, end;
};

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
/// They are kept by tiles, for who takes them in the end. Where primitives are small in the image,
/// directions and ends are also kept row by row: what such a primitive can end fits in one window
/// of 4×4 rays that begins anywhere, but lies in four tiles as often as not. Windows may reach
/// beyond the strip.
///
/// Serves strips of any image, one after another; allocates only while it grows.
class StripRays {
 public:
  /// Goes over to another strip, of which no tile has been met. The maker must outlive its use.
  void begin(const TileTable& table, TileRows strip, const TileMaker& maker);

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
  /// The same for all tiles of a rectangle that has rays left, which are then kept by rows too.
  void meet_by_rows(const ImageRect& rect, float near);

  /// Makes rows of the image rows of the strip; false: no part of the rectangle is in the strip.
  [[nodiscard]] bool clip(ImageRect& rect) const {
    rect.row0 = std::max(rect.row0, first_row_) - first_row_;
    rect.row1 = std::min(rect.row1, last_row_) - first_row_;
    return rect.row0 <= rect.row1;
  }
  /// Has any ray of the rectangle, or of its tiles, not ended?
  [[nodiscard]] bool any_left(const ImageRect& rect) const {
    const auto tile0 = static_cast<std::uint32_t>(rect.column0) / kTileEdge,
               tile1 = static_cast<std::uint32_t>(rect.column1) / kTileEdge;
    const auto row0 = static_cast<std::uint32_t>(rect.row0) / kTileEdge,
               row1 = static_cast<std::uint32_t>(rect.row1) / kTileEdge;
    for (std::uint32_t w = tile0 / 64; w <= tile1 / 64; ++w) {
      std::uint64_t left = 0;
      for (std::uint32_t row = row0; row <= row1; ++row) left |= tiles_left_[row * words_ + w];
      if ((left & columns_of(tile0, tile1, w)) != 0) return true;
    }
    return false;
  }
  /// The same to the ray, where rays are kept by rows.
  [[nodiscard]] bool any_left_in_rows(const ImageRect& rect) const {
    for (std::int32_t column = rect.column0; column <= rect.column1; column += kWordRays) {
      std::uint32_t bits = 0;
      for (std::int32_t row = rect.row0; row <= rect.row1; ++row) bits |= word(row, column);
      const std::int32_t rest = rect.column1 - column;
      if (rest < kWordRays - 1) bits &= (2U << rest) - 1U;
      if (bits != 0) return true;
    }
    return false;
  }
  /// Of the rays at columns c to c + 3 of a row that is kept those that have not ended, a bit each.
  [[nodiscard]] std::uint32_t left(std::int32_t row, std::int32_t column) const {
    return word(row, column) & 0xFU;
  }
  /// The tiles of a rectangle that have rays in it that have not ended, and those lanes. Valid
  /// until the next call.
  struct Left {
    std::uint32_t tile, lanes;
  };
  [[nodiscard]] std::span<const Left> left_in(const ImageRect& rect) {
    Left* out = found_.data();
    const auto column0 = static_cast<std::uint32_t>(rect.column0),
               column1 = static_cast<std::uint32_t>(rect.column1),
               row0 = static_cast<std::uint32_t>(rect.row0),
               row1 = static_cast<std::uint32_t>(rect.row1);
    const std::uint32_t tile0 = column0 / kTileEdge, tile1 = column1 / kTileEdge;
    const std::uint32_t first = (0xFU << column0 % kTileEdge & 0xFU) * 0x1111U,
                        last = (0xFU >> (kTileEdge - 1 - column1 % kTileEdge)) * 0x1111U;
    for (std::uint32_t row = row0 / kTileEdge; row <= row1 / kTileEdge; ++row) {
      std::uint32_t rows = 0xFFFFU;
      if (row == row0 / kTileEdge) rows &= 0xFFFFU << kTileEdge * (row0 % kTileEdge);
      if (row == row1 / kTileEdge) {
        rows &= 0xFFFFU >> kTileEdge * (kTileEdge - 1 - row1 % kTileEdge);
      }
      for (std::uint32_t w = tile0 / 64; w <= tile1 / 64; ++w) {
        std::uint64_t left = tiles_left_[row * words_ + w] & columns_of(tile0, tile1, w);
        for (; left != 0; left &= left - 1) {
          const std::uint32_t column = w * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
          const std::uint32_t tile = row * static_cast<std::uint32_t>(tile_columns_) + column;
          std::uint32_t lanes = left_in_tile_[tile] & rows;
          if (column == tile0) lanes &= first;
          if (column == tile1) lanes &= last;
          *out = {tile, lanes};
          out += lanes != 0 ? 1 : 0;
        }
      }
    }
    return {found_.data(), out};
  }

  /// Where a row of a window lies in the arrays below.
  [[nodiscard]] std::size_t place(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row) * pitch_ + static_cast<std::size_t>(column);
  }
  [[nodiscard]] std::size_t pitch() const { return pitch_; }
  [[nodiscard]] const float* direction(std::size_t axis) const { return rows_[axis].data(); }
  [[nodiscard]] const float* inverse(std::size_t axis) const { return rows_[3 + axis].data(); }
  [[nodiscard]] const float* range() const { return rows_[6].data(); }
  [[nodiscard]] const std::uint32_t* primitive() const { return primitive_.data(); }

  /// A ray that is kept by rows ends in a voxel; `is_final`: nothing nearer will follow.
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
      take_from_left(tile, 1U << lane);
      std::uint8_t& held = left_[y * left_pitch_ + x / 8];
      held = static_cast<std::uint8_t>(held & ~(1U << (x % 8)));
    } else {
      const std::size_t at = place(row, column);
      rows_[6][at] = range;
      primitive_[at] = primitive;
    }
  }
  /// Some rays of tile i, whose ends stand there.
  void end_in_tile(std::size_t i, std::uint32_t lanes, bool is_final) {
    if (lanes == 0) return;
    tiles_[i].hit |= lanes;
    if (is_final) {
      take_from_left(i, lanes);
      if (state_[i] == State::by_rows) mark_left(i);
    } else if (state_[i] == State::by_rows) {
      copy_ends(i);
    }
  }

 private:
  enum class State : std::uint8_t { not_met, met, by_rows };
  static constexpr std::int32_t kWordRays = 25;  // that a word of 32 bits surely has

  // The rays from a column on, a bit each, at least kWordRays of them.
  [[nodiscard]] std::uint32_t word(std::int32_t row, std::int32_t column) const {
    std::uint32_t bits;
    const auto y = static_cast<std::uint32_t>(row), x = static_cast<std::uint32_t>(column);
    std::memcpy(&bits, left_.data() + y * left_pitch_ + x / 8, sizeof(bits));
    return bits >> x % 8;
  }

  // Of word w of a row of tiles those from tile0 to tile1.
  [[nodiscard]] static std::uint64_t columns_of(std::uint32_t tile0, std::uint32_t tile1,
                                                std::uint32_t w) {
    std::uint64_t bits = ~std::uint64_t{0};
    if (w == tile0 / 64) bits &= ~std::uint64_t{0} << tile0 % 64;
    if (w == tile1 / 64) bits &= ~std::uint64_t{0} >> (63 - tile1 % 64);
    return bits;
  }
  void take_from_left(std::size_t tile, std::uint32_t lanes) {
    left_in_tile_[tile] = static_cast<std::uint16_t>(left_in_tile_[tile] & ~lanes);
    if (left_in_tile_[tile] != 0) return;
    const std::size_t column = tile % tile_columns_;
    tiles_left_[tile / tile_columns_ * words_ + column / 64] &= ~(std::uint64_t{1} << column % 64);
  }
  void make(std::size_t i, float near);
  // From the tiles to the rows.
  void copy(std::size_t i);
  void mark_left(std::size_t i) {
    const std::size_t row = i / tile_columns_ * kTileEdge, column = i % tile_columns_ * kTileEdge;
    std::uint8_t* at = &left_[row * left_pitch_ + column / 8];
    const unsigned shift = column % 8;
    for (unsigned k = 0; k < kTileEdge; ++k, at += left_pitch_) {
      const unsigned rays = left_in_tile_[i] >> (k * kTileEdge) & 0xFU;
      *at = static_cast<std::uint8_t>((*at & ~(0xFU << shift)) | rays << shift);
    }
  }
  void copy_ends(std::size_t i);
  // Of a tile's first ray.
  [[nodiscard]] std::size_t place_of(std::size_t i) const {
    return i / tile_columns_ * kTileEdge * pitch_ + i % tile_columns_ * kTileEdge;
  }

  std::size_t first_tile_ = 0, tile_columns_ = 0;
  std::int32_t first_row_ = 0, last_row_ = 0;  // of the image
  const TileMaker* maker_ = nullptr;
  std::vector<RayTile> tiles_;
  std::vector<State> state_;
  std::size_t pitch_ = 0, left_pitch_ = 0;
  std::array<std::vector<float>, 7> rows_;  // directions, inverses, ranges
  std::vector<std::uint32_t> primitive_;
  std::vector<std::uint16_t> left_in_tile_;  // lanes that have not ended
  std::vector<Left> found_;
  std::size_t words_ = 0;                  // a row of tiles
  std::vector<std::uint64_t> tiles_left_;  // a bit a tile that has such lanes
  std::vector<std::uint8_t> left_;         // the same row by row, a bit a ray
};

}  // namespace viewgain::detail
