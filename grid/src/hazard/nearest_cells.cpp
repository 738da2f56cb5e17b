// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "nearest_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "cell_kernels.hpp"

namespace viewgain::detail {
namespace {

// Along z: first from the nearest 0 below, then from the nearest above.
void along_row(const std::uint16_t* row, std::int16_t* squared, std::int8_t* best,
               std::size_t length) {
  constexpr int kNone = 128;  // with a square of at most 127² more, below 2^15
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

NearestCells::NearestCells(std::vector<std::uint16_t>& cells, const CellBox& size, int reach,
                           ThreadPool& pool)
    : size_(size),
      along_x_(std::make_unique_for_overwrite<std::int8_t[]>(cells.size())),
      along_y_(std::make_unique_for_overwrite<std::int8_t[]>(cells.size())),
      along_z_(std::make_unique_for_overwrite<std::int8_t[]>(cells.size())) {
  const CellKernels& kernels = cell_kernels(select_isa());
  const std::size_t nx = size[0], ny = size[1], nz = size[2], plane = ny * nz;
  const auto in_planes = std::make_unique_for_overwrite<std::int16_t[]>(cells.size());
  constexpr int kAny = std::numeric_limits<std::int16_t>::max();
  pool.for_each_chunk(nx, 1, [&](std::size_t x, std::size_t) {
    std::vector<std::int16_t> squared(plane), scratch;
    const std::size_t at = x * plane;
    for (std::size_t i = 0; i < plane; i += nz) {
      along_row(&cells[at + i], &squared[i], &along_z_[at + i], nz);
    }
    kernels.lower({nz, ny, nz}, reach, kAny, squared.data(), &in_planes[at], &along_y_[at],
                  scratch);
  });
  static_assert(kNoDistance == static_cast<std::uint16_t>(-1));
  auto* const out = reinterpret_cast<std::int16_t*>(cells.data());
  pool.for_each_chunk(ny, 1, [&](std::size_t y, std::size_t) {
    std::vector<std::int16_t> scratch;
    kernels.lower({plane, nx, nz}, reach, reach * reach, &in_planes[y * nz], out + y * nz,
                  &along_x_[y * nz], scratch);
  });
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
