// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "voxel_sums.hpp"

namespace viewgain::detail {

/// Sums the hits of one view by voxel and turns the sums into the paper's gain (raycast/README.md,
/// "Gains").
class GainAccumulator : public VoxelSums {
 public:
  GainAccumulator(const SceneData& scene, const GainSettings& settings, std::size_t max_rays);

  /// Fills gain, exploration, refinement, posterior_entropy, hits and voxel counts.
  void finish(ViewGain& result) {
    close();
    finish(explored(), refined(), result);
  }

  /// finish() in parts: after close() explored(), of the unknown voxels, and refined(), of the
  /// occupied ones, may run on two threads at once.
  struct ClassGain {
    double gain = 0, posterior_entropy = 0;
  };
  [[nodiscard]] ClassGain explored();
  [[nodiscard]] ClassGain refined();
  void finish(const ClassGain& explored, const ClassGain& refined, ViewGain& result) const;

 private:
  [[nodiscard]] ClassGain gain_of(std::span<const std::uint32_t> members, const LogProduct& ratios,
                                  const LogProduct& posterior, const double* each) const;

  std::vector<double> each_;  // what voxels gain, unknown ones first; for weights and the trace
};

}  // namespace viewgain::detail
