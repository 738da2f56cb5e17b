// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/proximity_measure.hpp"

#include <algorithm>
#include <cmath>

namespace viewgain {
namespace {

constexpr double kCoarseRays = 400;

}  // namespace

ProximityMeasure::ProximityMeasure(const HazardField& hazard)
    : hazard_(hazard), cut_(HazardConfig::Model::kCut * hazard.model().decay_length) {}

double ProximityMeasure::measure(const Pose&, std::span<const RunMeasure::Run> runs) const {
  double sum = 0;
  for (const RunMeasure::Run& run : runs) {
    if (run.state != VoxelState::unknown) continue;
    sum += std::max(0.0, 1.0 - hazard_.distance(run.voxel) / cut_);
  }
  return sum;
}

int coarse_stride(const PinholeCamera& camera) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  return std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / kCoarseRays))));
}

}  // namespace viewgain
