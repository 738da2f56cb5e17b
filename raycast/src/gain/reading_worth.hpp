// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frontal_sigmas.hpp"

namespace viewgain::detail {

/// What new surface at range t counts for: ρ(t) = (1 + s(w)) / (1 + s(t)), s(t) = σ_ax(t) / V,
/// with the working distance w and the voxel size V. Readings that miss the surface by more than
/// voxels make no points on it (perf/results/prediction.md, "Far views").
struct ReadingWorth {
  double scale;           ///< 1 + s(w)
  double s0, s1, s2, at;  ///< s(t) = s0 + s1 t + s2 (t - at)²; s1 [1/m], s2 [1/m²], at [m]

  ReadingWorth(const FrontalSigmas& sigmas, double working_distance, double voxel_size);

  /// ρ at a range [m].
  [[nodiscard]] double operator()(double range) const {
    return scale / (1 + s0 + s1 * range + s2 * (range - at) * (range - at));
  }
};

}  // namespace viewgain::detail
