// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "point_grid.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace viewgain::detail {

PointGrid::PointGrid(std::span<const Point3> points, double cell_size)
    : inverse_cell_size_(1.0 / cell_size), order_(points.size()), sorted_(points.size()) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3& p = points[i];
    keyed[i] = {key_of(cell_of(p[0]), cell_of(p[1]), cell_of(p[2])), static_cast<std::uint32_t>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t i = 0; i < keyed.size(); ++i) {
    order_[i] = keyed[i].second;
    sorted_[i] = points[keyed[i].second];
  }

  const std::size_t size = std::bit_ceil(2 * points.size() + 2);
  shift_ = 64U - static_cast<unsigned>(std::countr_zero(size));
  slots_.resize(size);
  for (std::size_t begin = 0; begin < keyed.size();) {
    std::size_t end = begin + 1;
    while (end < keyed.size() && keyed[end].first == keyed[begin].first) ++end;
    std::size_t s = home(keyed[begin].first);
    while (slots_[s].begin != slots_[s].end) s = (s + 1) & (size - 1);
    slots_[s] = {keyed[begin].first, static_cast<std::uint32_t>(begin),
                 static_cast<std::uint32_t>(end)};
    begin = end;
  }
}

}  // namespace viewgain::detail
