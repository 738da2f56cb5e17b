// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "squared_distances.hpp"

#include <algorithm>

namespace viewgain::detail {
namespace {

// On the way distances are capped, so that adding a square of at most 127² stays below 2^16.
constexpr std::uint16_t kFar = 40000;

// out[i] = min over |k| <= reach of in[i + k stride] + k², one row of `length` cells after another;
// `position` of `count` rows along the axis. Branchless in the inner loop, so that compilers make
// vectors of it.
void lower(const std::uint16_t* in, std::uint16_t* out, std::size_t length, std::size_t stride,
           std::size_t position, std::size_t count, int reach) {
  std::copy(in, in + length, out);
  const auto take = [&](const std::uint16_t* other, std::uint16_t square) {
    for (std::size_t i = 0; i < length; ++i) {
      out[i] = std::min(out[i], static_cast<std::uint16_t>(other[i] + square));
    }
  };
  for (int k = 1; k <= reach; ++k) {
    const auto steps = static_cast<std::size_t>(k);
    const auto square = static_cast<std::uint16_t>(k * k);
    if (steps <= position) take(in - steps * stride, square);
    if (position + steps < count) take(in + steps * stride, square);
  }
}

// Along z: from the nearest 0 before, then from the nearest behind.
void along_row(std::uint16_t* row, std::size_t length) {
  std::uint32_t away = 200;
  const auto step = [&](std::uint16_t& cell) {
    away = cell == 0 ? 0 : std::min<std::uint32_t>(away + 1, 200);
    cell = static_cast<std::uint16_t>(std::min<std::uint32_t>(cell, away * away));
  };
  for (std::size_t i = 0; i < length; ++i) step(row[i]);
  away = 200;
  for (std::size_t i = length; i-- > 0;) step(row[i]);
}

}  // namespace

void find_squared_distances(std::vector<std::uint16_t>& cells,
                            const std::array<std::size_t, 3>& size, int reach) {
  for (std::uint16_t& cell : cells) cell = std::min(cell, kFar);
  const std::size_t plane = size[1] * size[2];
  for (std::size_t i = 0; i < cells.size(); i += size[2]) along_row(&cells[i], size[2]);
  std::vector<std::uint16_t> other(cells.size());
  for (std::size_t x = 0; x < size[0]; ++x) {
    for (std::size_t y = 0; y < size[1]; ++y) {
      const std::size_t at = x * plane + y * size[2];
      lower(&cells[at], &other[at], size[2], size[2], y, size[1], reach);
    }
  }
  for (std::size_t x = 0; x < size[0]; ++x) {
    lower(&other[x * plane], &cells[x * plane], plane, plane, x, size[0], reach);
  }
  const auto most = static_cast<std::uint16_t>(reach * reach);
  for (std::uint16_t& cell : cells) {
    if (cell > most) cell = kNoDistance;
  }
}

}  // namespace viewgain::detail
