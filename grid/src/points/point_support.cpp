// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "point_support.hpp"

#include <algorithm>

#include "point_cells.hpp"

namespace viewgain::detail {

std::vector<bool> well_supported(const std::vector<SupportedPoint>& points, double radius,
                                 double share) {
  PointCells<std::size_t> cells(radius);
  for (std::size_t i = 0; i < points.size(); ++i) cells.at(points[i].position).push_back(i);
  std::vector<bool> kept(points.size());
  std::vector<double> around;
  for (std::size_t i = 0; i < points.size(); ++i) {
    around.clear();
    cells.for_each_near(points[i].position, [&](std::size_t j) {
      if ((points[j].position - points[i].position).squaredNorm() <= radius * radius) {
        around.push_back(points[j].evidence);
      }
    });
    const auto quartile = around.begin() + static_cast<std::ptrdiff_t>(around.size() * 3 / 4);
    std::nth_element(around.begin(), quartile, around.end());
    kept[i] = points[i].evidence >= share * *quartile;
  }
  return kept;
}

}  // namespace viewgain::detail
