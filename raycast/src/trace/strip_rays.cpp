// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "strip_rays.hpp"

#include "scene/scene_data.hpp"

namespace viewgain::detail {

void StripRays::begin(const TileTable& table, TileRows strip, const TileMaker& maker) {
  maker_ = &maker;
  tile_columns_ = table.tile_columns();
  const std::size_t tile_rows = strip.end - strip.begin, count = tile_rows * tile_columns_;
  first_tile_ = strip.begin * tile_columns_;
  first_row_ = static_cast<std::int32_t>(strip.begin) * kTileEdge;
  last_row_ = static_cast<std::int32_t>(strip.end) * kTileEdge - 1;
  state_.assign(count, State::not_met);
  if (tiles_.size() < count) {
    found_.resize(count + 1);  // first: memory may run out in between
    tiles_.resize(count);
  }
  const auto valid = table.valid.begin() + static_cast<std::ptrdiff_t>(first_tile_);
  left_in_tile_.assign(valid, valid + static_cast<std::ptrdiff_t>(count));
  words_ = (tile_columns_ + 63) / 64;
  tiles_left_.assign(tile_rows * words_, 0);
  for (std::size_t row = 0; row < tile_rows; ++row) {
    const std::uint16_t* lanes = left_in_tile_.data() + row * tile_columns_;
    for (std::size_t column = 0; column < tile_columns_; ++column) {
      const std::uint64_t bit = lanes[column] != 0 ? 1 : 0;
      tiles_left_[row * words_ + column / 64] |= bit << column % 64;
    }
  }
  // A window may begin at the last column and row.
  const std::size_t rows = (tile_rows + 1) * kTileEdge;
  pitch_ = (tile_columns_ + 1) * kTileEdge;
  left_pitch_ = tile_columns_ / 2 + 1 + sizeof(std::uint32_t);
  left_.assign(rows * left_pitch_, 0);
}

void StripRays::make(std::size_t i, float near) {
  maker_->make(first_tile_ + i, near, tiles_[i]);
  state_[i] = State::met;
}

void StripRays::meet_by_rows(const ImageRect& rect, float near) {
  for (std::int32_t row = rect.row0 / kTileEdge; row <= rect.row1 / kTileEdge; ++row) {
    for (std::int32_t c = rect.column0 / kTileEdge; c <= rect.column1 / kTileEdge; ++c) {
      const std::size_t i =
          static_cast<std::size_t>(row) * tile_columns_ + static_cast<std::size_t>(c);
      if (state_[i] == State::by_rows || left_in_tile_[i] == 0) continue;
      (void)meet(i, near);
      copy(i);
    }
  }
}

void StripRays::copy(std::size_t i) {
  // Not before it is needed: half as large as all tiles.
  const std::size_t size = left_.size() / left_pitch_ * pitch_;
  if (primitive_.size() < size) {
    for (auto& values : rows_) values.resize(size);
    primitive_.resize(size);
  }
  state_[i] = State::by_rows;
  const RayTile& tile = tiles_[i];
  mark_left(i);
  const std::array<const float*, 6> from{tile.dx, tile.dy, tile.dz, tile.ix, tile.iy, tile.iz};
  const std::size_t at = place_of(i);
  for (std::size_t value = 0; value < from.size(); ++value) {
    for (std::size_t k = 0; k < kTileEdge; ++k) {
      std::memcpy(&rows_[value][at + k * pitch_], from[value] + k * kTileEdge,
                  kTileEdge * sizeof(float));
    }
  }
  copy_ends(i);
}

void StripRays::copy_ends(std::size_t i) {
  const std::size_t at = place_of(i);
  for (std::size_t k = 0; k < kTileEdge; ++k) {
    std::memcpy(&rows_[6][at + k * pitch_], tiles_[i].range + k * kTileEdge,
                kTileEdge * sizeof(float));
    std::memcpy(&primitive_[at + k * pitch_], tiles_[i].primitive + k * kTileEdge,
                kTileEdge * sizeof(std::uint32_t));
  }
}

}  // namespace viewgain::detail
