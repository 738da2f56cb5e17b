// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "point_support.hpp"

#include <algorithm>

#include "point_cells.hpp"

namespace viewgain::detail {

std::vector<std::uint8_t> well_supported(const std::vector<SupportedPoint>& points, double radius,
                                         double share, ThreadPool& pool) {
  PointCells<std::size_t> cells(radius);
  for (std::size_t i = 0; i < points.size(); ++i) cells.at(points[i].position).push_back(i);
  std::vector<std::uint8_t> kept(points.size());
  pool.for_each_chunk(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<double> around;
    for (std::size_t i = begin; i < end; ++i) {
      around.clear();
      cells.for_each_near(points[i].position, [&](std::size_t j) {
        if ((points[j].position - points[i].position).squaredNorm() <= radius * radius) {
          around.push_back(points[j].evidence);
        }
      });
      const auto quartile = around.begin() + static_cast<std::ptrdiff_t>(around.size() * 3 / 4);
      std::nth_element(around.begin(), quartile, around.end());
      kept[i] = points[i].evidence >= share * *quartile ? 1 : 0;
    }
  });
  return kept;
}

}  // namespace viewgain::detail
