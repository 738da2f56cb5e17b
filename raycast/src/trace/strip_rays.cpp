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
  left_.begin(table, strip);
  state_.assign(count, State::not_met);
  if (tiles_.size() < count) tiles_.resize(count);
  // A window may begin at the last column and row.
  row_count_ = (tile_rows + 1) * kTileEdge;
  pitch_ = (tile_columns_ + 1) * kTileEdge;
}

void StripRays::make(std::size_t i, float near) {
  const std::uint32_t ended = maker_->make(first_tile_ + i, near, tiles_[i]);
  state_[i] = State::met;
  if (ended != 0) left_.take(i, ended);
}

void StripRays::meet_by_rows(const ImageRect& rect, float near) {
  for (std::int32_t row = rect.row0 / kTileEdge; row <= rect.row1 / kTileEdge; ++row) {
    for (std::int32_t c = rect.column0 / kTileEdge; c <= rect.column1 / kTileEdge; ++c) {
      const std::size_t i =
          static_cast<std::size_t>(row) * tile_columns_ + static_cast<std::size_t>(c);
      if (state_[i] == State::by_rows || left_.of_tile(i) == 0) continue;
      (void)meet(i, near);
      copy_to_rows(i);
    }
  }
}

void StripRays::copy_to_rows(std::size_t i) {
  // Not before it is needed: half as large as all tiles.
  const std::size_t size = row_count_ * pitch_;
  if (primitive_.size() < size) {
    for (auto& values : rows_) values.resize(size);
    primitive_.resize(size);
  }
  state_[i] = State::by_rows;
  left_.copy_to_rows(i);
  const RayTile& tile = tiles_[i];
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
