// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scale_plan.hpp"

#include <array>
#include <cmath>
#include <string>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

// Number of voxels per pixel from which the next scale is used: as in supereight2 (Vespa et al.
// 2019; Funk et al. 2021).
constexpr std::array<double, kMaxScale> kThresholds{1.5, 3, 6};

}  // namespace

ScalePlan::ScalePlan(const IntegrationConfig& config)
    : coarsest_(config.coarsest), finest_(config.finest), fine_(config.fine) {
  if (coarsest_ < 0 || coarsest_ > kMaxScale) {
    refuse("the coarsest scale must be in 0.." + std::to_string(kMaxScale) + ", not " +
           std::to_string(coarsest_));
  }
  if (finest_ < 0 || finest_ > coarsest_) {
    refuse("the finest scale must be between 0 and the coarsest scale, " +
           std::to_string(coarsest_) + ", not " + std::to_string(finest_));
  }
  for (const Box& box : fine_) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (box.min[a] < box.max[a]) continue;
      refuse(std::string("a box for fine voxels is inside out or empty: along ") + "xyz"[a] +
             " it extends from " + short_text(box.min[a]) + " to " + short_text(box.max[a]));
    }
  }
}

void ScalePlan::look(const PlacedFrame& frame, const BeliefGrid& map) {
  frame_ = &frame;
  map_ = &map;
  lattice_.emplace(map.min_index(), map.dims());
  eye_ = frame.T_grid_readings * frame.readings.origin();
}

int ScalePlan::wanted(Index3 origin, double margin) const {
  if (coarsest_ == 0) return 0;
  const double V = map_->voxel_size();
  const Eigen::Vector3d low = Eigen::Vector3d(origin.x, origin.y, origin.z) * V;
  const Eigen::Vector3d high = low.array() + kBlockSize * V;
  for (const Box& box : fine_) {
    bool touches = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      touches = touches && low[axis] < box.max[a] && high[axis] > box.min[a];
    }
    if (touches) return 0;
  }
  const Sensor& sensor = frame_->readings.sensor();
  const double t = (eye_ - eye_.cwiseMax(low).cwiseMin(high)).norm();
  const double footprint = t / std::sqrt(sensor.camera.fx * sensor.camera.fy);
  const double size = margin * std::max(footprint, sensor.noise_sigmas(t).axial) / V;
  int scale = finest_;
  while (scale < coarsest_ && size >= kThresholds[static_cast<std::size_t>(scale)]) ++scale;
  return fitting_scale(*lattice_, origin, scale);
}

void ScalePlan::set(BeliefGrid& map, std::uint64_t key) const {
  const Index3 origin = lattice_->origin(key);
  set_scale(map, key, is_held(map, key) ? of_held(origin, scale_of(map, key)) : of_new(origin));
}

}  // namespace viewgain::detail
