// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "nearest_cells.hpp"

#include <algorithm>
#include <cstddef>

namespace viewgain::detail {
namespace {

// Intermediate distances are capped, so that adding a square of at most 127² stays below 2^15,
// because instruction sets have 16-bit minima.
constexpr std::int16_t kFar = 128 * 128;
constexpr std::size_t kChunk = 32;  // cells that a pass takes through its steps at once

// Rows of cells in chunks; a short last chunk overlaps the one before.
struct Chunks {
  std::size_t length;
  [[nodiscard]] std::size_t count() const { return (length + kChunk - 1) / kChunk; }
  [[nodiscard]] std::size_t begin(std::size_t chunk) const {
    return length < kChunk ? 0 : std::min(chunk * kChunk, length - kChunk);
  }
  [[nodiscard]] std::size_t size() const { return std::min(length, kChunk); }
};

// An axis: `count` rows at distance `stride`.
struct Axis {
  std::size_t stride, count;
};

// out[i] = min over |k| <= reach of in[i + k stride] + k² for a chunk of a row at index `position`
// of the axis; `best` is the k, nearest row first, the lower one first. Skips rows that cannot
// lower the result, or not below reach²: `least` has the minimum of each row's chunk.
void lower(const std::int16_t* in, std::int16_t* out, std::int8_t* best, std::size_t size,
           const Axis& axis, std::size_t position, const std::int16_t* least,
           std::size_t least_stride, int reach) {
  std::array<std::int16_t, kChunk> lowest{}, step{};
  std::copy(in, in + size, lowest.begin());
  std::int16_t most = *std::max_element(lowest.begin(), lowest.begin() + std::ptrdiff_t(size));
  const int limit = reach * reach;
  const auto take = [&](std::ptrdiff_t rows, int square) {
    const int from = least[rows * std::ptrdiff_t(least_stride)] + square;
    if (from > limit || from >= most) return;
    const std::int16_t* other = in + rows * std::ptrdiff_t(axis.stride);
    const auto added = static_cast<std::int16_t>(square), k = static_cast<std::int16_t>(rows);
    const auto each = [&](std::size_t i) {
      const auto through = static_cast<std::int16_t>(other[i] + added);
      step[i] = through < lowest[i] ? k : step[i];
      lowest[i] = std::min(lowest[i], through);
    };
    if (size == kChunk) {  // fixed length, for vectorisation
      for (std::size_t i = 0; i < kChunk; ++i) each(i);
    } else {
      for (std::size_t i = 0; i < size; ++i) each(i);
    }
  };
  for (int k = 1; k <= reach && k * k < most; ++k) {
    const auto rows = static_cast<std::size_t>(k);
    if (rows <= position) take(-k, k * k);
    if (position + rows < axis.count) take(k, k * k);
    most = 0;
    for (const std::int16_t value : lowest) most = std::max(most, value);
  }
  std::copy_n(lowest.begin(), size, out);
  std::transform(step.begin(), step.begin() + std::ptrdiff_t(size), best,
                 [](std::int16_t k) { return static_cast<std::int8_t>(k); });
}

// lower() for all rows of `length` cells along an axis whose rows are `rows_apart` apart.
void pass(const std::vector<std::int16_t>& in, std::vector<std::int16_t>& out,
          std::vector<std::int8_t>& best, std::size_t length, std::size_t rows_apart,
          std::size_t count, int reach) {
  const Chunks chunks{length};
  const std::size_t rows = in.size() / length, per_row = chunks.count();
  std::vector<std::int16_t> least(rows * per_row);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t chunk = 0; chunk < per_row; ++chunk) {
      const auto begin = in.begin() + std::ptrdiff_t(row * length + chunks.begin(chunk));
      least[row * per_row + chunk] =
          *std::min_element(begin, begin + std::ptrdiff_t(chunks.size()));
    }
  }
  const Axis axis{rows_apart * length, count};
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t chunk = 0; chunk < per_row; ++chunk) {
      const std::size_t at = row * length + chunks.begin(chunk);
      lower(&in[at], &out[at], &best[at], chunks.size(), axis, row / rows_apart % count,
            &least[row * per_row + chunk], rows_apart * per_row, reach);
    }
  }
}

// Along z: first from the nearest 0 below, then from the nearest above.
void along_row(const std::uint16_t* row, std::int16_t* squared, std::int8_t* best,
               std::size_t length) {
  constexpr int kNone = 128;  // its square is kFar
  int away = kNone;
  for (std::size_t i = 0; i < length; ++i) {
    away = row[i] == 0 ? 0 : std::min(away + 1, kNone);
    best[i] = static_cast<std::int8_t>(-away);
  }
  away = kNone;
  for (std::size_t i = length; i-- > 0;) {
    away = row[i] == 0 ? 0 : std::min(away + 1, kNone);
    if (away < -best[i]) best[i] = static_cast<std::int8_t>(away);
    squared[i] = static_cast<std::int16_t>(best[i] * best[i]);
  }
}

}  // namespace

NearestCells::NearestCells(std::vector<std::uint16_t>& cells, const CellBox& size, int reach)
    : size_(size), along_x_(cells.size()), along_y_(cells.size()), along_z_(cells.size()) {
  std::vector<std::int16_t> squared(cells.size()), other(cells.size());
  for (std::size_t i = 0; i < cells.size(); i += size[2]) {
    along_row(&cells[i], &squared[i], &along_z_[i], size[2]);
  }
  pass(squared, other, along_y_, size[2], 1, size[1], reach);
  pass(other, squared, along_x_, size[2], size[1], size[0], reach);
  const int most = reach * reach;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i] = squared[i] > most ? kNoDistance : static_cast<std::uint16_t>(squared[i]);
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
