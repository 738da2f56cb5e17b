// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "nearest_cells.hpp"

#include <algorithm>

namespace viewgain::detail {
namespace {

// On the way distances are capped, so that adding a square of at most 127² stays below 2^16.
constexpr std::uint16_t kFar = 40000;

// out[i] = min over |k| <= reach of in[i + k stride] + k², one row of `length` cells after another,
// and `best` the k; `position` of `count` rows along the axis. Branchless in the inner loop, so
// that compilers make vectors of it.
void lower(const std::uint16_t* in, std::uint16_t* out, std::int16_t* best, std::size_t length,
           std::size_t stride, std::size_t position, std::size_t count, int reach) {
  std::copy(in, in + length, out);
  std::fill(best, best + length, std::int16_t{0});
  const auto take = [&](const std::uint16_t* other, std::uint16_t square, std::int16_t k) {
    for (std::size_t i = 0; i < length; ++i) {
      const auto through = static_cast<std::uint16_t>(other[i] + square);
      best[i] = through < out[i] ? k : best[i];
      out[i] = std::min(out[i], through);
    }
  };
  for (int k = 1; k <= reach; ++k) {
    const auto steps = static_cast<std::size_t>(k);
    const auto square = static_cast<std::uint16_t>(k * k);
    if (steps <= position) take(in - steps * stride, square, static_cast<std::int16_t>(-k));
    if (position + steps < count) take(in + steps * stride, square, static_cast<std::int16_t>(k));
  }
}

// Along z: from the nearest 0 before, then from the nearest behind.
void along_row(std::uint16_t* row, std::int16_t* best, std::size_t length) {
  constexpr int kNone = 200;
  int away = kNone;
  for (std::size_t i = 0; i < length; ++i) {
    away = row[i] == 0 ? 0 : std::min(away + 1, kNone);
    best[i] = static_cast<std::int16_t>(-away);
  }
  away = kNone;
  for (std::size_t i = length; i-- > 0;) {
    away = row[i] == 0 ? 0 : std::min(away + 1, kNone);
    if (away < -best[i]) best[i] = static_cast<std::int16_t>(away);
    row[i] = std::min(row[i], static_cast<std::uint16_t>(best[i] * best[i]));
  }
}

}  // namespace

NearestCells::NearestCells(std::vector<std::uint16_t>& cells, const CellBox& size, int reach)
    : size_(size), along_x_(cells.size()), along_y_(cells.size()), along_z_(cells.size()) {
  for (std::uint16_t& cell : cells) cell = std::min(cell, kFar);
  const std::size_t plane = size[1] * size[2];
  for (std::size_t i = 0; i < cells.size(); i += size[2]) {
    along_row(&cells[i], &along_z_[i], size[2]);
  }
  std::vector<std::uint16_t> other(cells.size());
  for (std::size_t x = 0; x < size[0]; ++x) {
    for (std::size_t y = 0; y < size[1]; ++y) {
      const std::size_t at = x * plane + y * size[2];
      lower(&cells[at], &other[at], &along_y_[at], size[2], size[2], y, size[1], reach);
    }
  }
  for (std::size_t x = 0; x < size[0]; ++x) {
    lower(&other[x * plane], &cells[x * plane], &along_x_[x * plane], plane, plane, x, size[0],
          reach);
  }
  const auto most = static_cast<std::uint16_t>(reach * reach);
  for (std::uint16_t& cell : cells) {
    if (cell > most) cell = kNoDistance;
  }
}

std::array<int, 3> NearestCells::offset(std::size_t x, std::size_t y, std::size_t z) const {
  const auto at = [&](std::size_t i, std::size_t j) { return (i * size_[1] + j) * size_[2] + z; };
  const auto moved = [](std::size_t from, int by) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(from) + by);
  };
  const int dx = along_x_[at(x, y)];
  const int dy = along_y_[at(moved(x, dx), y)];
  const int dz = along_z_[at(moved(x, dx), moved(y, dy))];
  return {dx, dy, dz};
}

}  // namespace viewgain::detail
