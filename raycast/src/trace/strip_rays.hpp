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

/// Which rays of a strip of the image have not ended. Kept three times, each for one question:
///
///     by tile, its 16 lanes          which rays of these tiles?   in()
///     by tile, a bit if any is left  any in this rectangle?       any_in_tiles()
///     by ray, row by row             any to the ray, which four?  any_in_rows(), four()
///
/// The last only for tiles that copy_to_rows() was called for, and as take() leaves it after that.
/// Rectangles are in rays of the strip. Serves strips of any image; allocates only while it grows.
class RaysLeft {
 public:
  /// Another strip, of which no ray has ended; none is kept by rows.
  void begin(const TileTable& table, TileRows strip) {
    const std::size_t tile_rows = strip.end - strip.begin, columns = table.tile_columns();
    const std::size_t count = tile_rows * columns;
    columns_ = static_cast<std::uint32_t>(columns);
    if (found_.size() <= count) found_.resize(count + 1);
    const auto valid = table.valid.begin() + static_cast<std::ptrdiff_t>(strip.begin * columns);
    lanes_.assign(valid, valid + static_cast<std::ptrdiff_t>(count));
    words_ = (columns_ + 63) / 64;
    tiles_.assign(tile_rows * words_, 0);
    for (std::size_t row = 0; row < tile_rows; ++row) {
      const std::uint16_t* lanes = lanes_.data() + row * columns;
      for (std::size_t column = 0; column < columns; ++column) {
        const std::uint64_t bit = lanes[column] != 0 ? 1 : 0;
        tiles_[row * words_ + column / 64] |= bit << column % 64;
      }
    }
    // A window of rays may begin at the last column and row.
    pitch_ = columns / 2 + 1 + sizeof(std::uint32_t);
    rays_.assign((tile_rows + 1) * kTileEdge * pitch_, 0);
  }

  /// The lanes of tile i.
  [[nodiscard]] std::uint32_t of_tile(std::size_t i) const { return lanes_[i]; }

  /// Has any tile of the rectangle a ray left, in it or beside?
  [[nodiscard]] bool any_in_tiles(const ImageRect& rect) const {
    const Tiles tiles(rect);
    for (std::uint32_t w = tiles.column0 / 64; w <= tiles.column1 / 64; ++w) {
      std::uint64_t left = 0;
      for (std::uint32_t row = tiles.row0; row <= tiles.row1; ++row) {
        left |= tiles_[row * words_ + w];
      }
      if ((left & tiles.columns_of(w)) != 0) return true;
    }
    return false;
  }

  struct TileLanes {
    std::uint32_t tile, lanes;
  };
  /// The tiles of the rectangle that have rays left in it, and those lanes. Valid until the next
  /// call.
  [[nodiscard]] std::span<const TileLanes> in(const ImageRect& rect) {
    const Tiles tiles(rect);
    const auto edge = [](std::int32_t ray) { return static_cast<std::uint32_t>(ray) % kTileEdge; };
    // The lanes of tiles at the rectangle's sides that lie in it.
    const std::uint32_t left_side = (0xFU << edge(rect.column0) & 0xFU) * 0x1111U,
                        right_side = (0xFU >> (kTileEdge - 1 - edge(rect.column1))) * 0x1111U,
                        top = 0xFFFFU << kTileEdge * edge(rect.row0),
                        bottom = 0xFFFFU >> kTileEdge * (kTileEdge - 1 - edge(rect.row1));
    TileLanes* out = found_.data();
    for (std::uint32_t row = tiles.row0; row <= tiles.row1; ++row) {
      std::uint32_t rows = 0xFFFFU;
      if (row == tiles.row0) rows &= top;
      if (row == tiles.row1) rows &= bottom;
      for (std::uint32_t w = tiles.column0 / 64; w <= tiles.column1 / 64; ++w) {
        std::uint64_t left = tiles_[row * words_ + w] & tiles.columns_of(w);
        for (; left != 0; left &= left - 1) {
          const std::uint32_t column = w * 64 + static_cast<std::uint32_t>(std::countr_zero(left));
          const std::uint32_t tile = row * columns_ + column;
          std::uint32_t lanes = lanes_[tile] & rows;
          if (column == tiles.column0) lanes &= left_side;
          if (column == tiles.column1) lanes &= right_side;
          *out = {tile, lanes};
          out += lanes != 0 ? 1 : 0;
        }
      }
    }
    return {found_.data(), out};
  }

  /// The rays have ended.
  void take(std::size_t tile, std::uint32_t lanes) {
    lanes_[tile] = static_cast<std::uint16_t>(lanes_[tile] & ~lanes);
    if (lanes_[tile] != 0) return;
    const std::size_t column = tile % columns_;
    tiles_[tile / columns_ * words_ + column / 64] &= ~(std::uint64_t{1} << column % 64);
  }

  /// Has any ray of the rectangle, all of which is kept by rows, not ended?
  [[nodiscard]] bool any_in_rows(const ImageRect& rect) const {
    for (std::int32_t column = rect.column0; column <= rect.column1; column += kWordRays) {
      std::uint32_t bits = 0;
      for (std::int32_t row = rect.row0; row <= rect.row1; ++row) bits |= word(row, column);
      const std::int32_t rest = rect.column1 - column;
      if (rest < kWordRays - 1) bits &= (2U << rest) - 1U;
      if (bits != 0) return true;
    }
    return false;
  }
  /// Of the rays at columns c to c + 3 of a row those that have not ended, a bit each.
  [[nodiscard]] std::uint32_t four(std::int32_t row, std::int32_t column) const {
    return word(row, column) & 0xFU;
  }
  void copy_to_rows(std::size_t tile) {
    const std::size_t row = tile / columns_ * kTileEdge, column = tile % columns_ * kTileEdge;
    std::uint8_t* at = &rays_[row * pitch_ + column / 8];
    const unsigned shift = column % 8;
    for (unsigned k = 0; k < kTileEdge; ++k, at += pitch_) {
      const unsigned rays = static_cast<unsigned>(lanes_[tile]) >> (k * kTileEdge) & 0xFU;
      *at = static_cast<std::uint8_t>((*at & ~(0xFU << shift)) | rays << shift);
    }
  }
  void take_from_rows(std::uint32_t row, std::uint32_t column) {
    std::uint8_t& held = rays_[row * pitch_ + column / 8];
    held = static_cast<std::uint8_t>(held & ~(1U << (column % 8)));
  }

 private:
  static constexpr std::int32_t kWordRays = 25;  // that a word of 32 bits surely has

  // The tiles that a rectangle touches.
  struct Tiles {
    std::uint32_t row0, row1, column0, column1;

    explicit Tiles(const ImageRect& rect)
        : row0(static_cast<std::uint32_t>(rect.row0) / kTileEdge),
          row1(static_cast<std::uint32_t>(rect.row1) / kTileEdge),
          column0(static_cast<std::uint32_t>(rect.column0) / kTileEdge),
          column1(static_cast<std::uint32_t>(rect.column1) / kTileEdge) {}
    // Of word w of a row of tiles.
    [[nodiscard]] std::uint64_t columns_of(std::uint32_t w) const {
      std::uint64_t bits = ~std::uint64_t{0};
      if (w == column0 / 64) bits &= ~std::uint64_t{0} << column0 % 64;
      if (w == column1 / 64) bits &= ~std::uint64_t{0} >> (63 - column1 % 64);
      return bits;
    }
  };

  // The rays from a column on, a bit each, at least kWordRays of them.
  [[nodiscard]] std::uint32_t word(std::int32_t row, std::int32_t column) const {
    std::uint32_t bits;
    const auto y = static_cast<std::uint32_t>(row), x = static_cast<std::uint32_t>(column);
    std::memcpy(&bits, rays_.data() + y * pitch_ + x / 8, sizeof(bits));
    return bits >> x % 8;
  }

  std::uint32_t columns_ = 0;  // of tiles
  std::vector<std::uint16_t> lanes_;
  std::size_t words_ = 0;  // a row of tiles
  std::vector<std::uint64_t> tiles_;
  std::size_t pitch_ = 0;  // bytes a row of rays
  std::vector<std::uint8_t> rays_;
  std::vector<TileLanes> found_;
};

/// Makes tiles when they are first met.
class TileMaker {
 public:
  TileMaker() = default;
  TileMaker(const TileMaker&) = delete;
  TileMaker& operator=(const TileMaker&) = delete;
  /// `near`: neither this nor any other primitive that is still to come begins much nearer, along
  /// the optical axis [voxels]. Returns the lanes that end before any primitive.
  virtual std::uint32_t make(std::size_t tile, float near, RayTile& out) const = 0;

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
