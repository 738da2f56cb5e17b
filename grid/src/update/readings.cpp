// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "readings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viewgain::detail {

void Readings::resize(std::size_t count) {
  kinds_.resize(count);
  points_.resize(count);
  sigmas_.resize(count);
  reach_taper_.resize(2 * count);
}

PixelKind Readings::sort_by_range(std::size_t pixel, double range) {
  PixelKind kind = PixelKind::invalid;
  double reach = 0;
  if (range >= sensor_.min_range) {
    if (range <= sensor_.max_range) {
      kind = PixelKind::reading;
      reach = range;
    } else {
      kind = PixelKind::out_of_range;
      // A centre exactly at max_range is still crossed.
      reach = std::nextafter(sensor_.max_range, std::numeric_limits<double>::infinity());
    }
  }
  kinds_[pixel] = kind;
  reach_taper_[2 * pixel] = reach;
  reach_taper_[2 * pixel + 1] = 0.0;
  return kind;
}

std::optional<Box> bounds_of(const Readings& readings, const Pose& T_grid_readings) {
  std::optional<Box> box;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (readings.kind(i) != PixelKind::reading) continue;
    const Eigen::Vector3d p = T_grid_readings * readings.point(i);
    if (!box) box = Box{{p.x(), p.y(), p.z()}, {p.x(), p.y(), p.z()}};
    for (std::size_t a = 0; a < 3; ++a) {
      box->min[a] = std::min(box->min[a], p[static_cast<Eigen::Index>(a)]);
      box->max[a] = std::max(box->max[a], p[static_cast<Eigen::Index>(a)]);
    }
  }
  return box;
}

}  // namespace viewgain::detail
