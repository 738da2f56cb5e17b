// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "reading_worth.hpp"

namespace viewgain::detail {

ReadingWorth::ReadingWorth(const FrontalSigmas& sigmas, double working_distance, double voxel_size)
    : scale(1),
      s0(sigmas.a0 / voxel_size),
      s1(sigmas.a1 / voxel_size),
      s2(sigmas.a2 / voxel_size),
      at(sigmas.v) {
  scale = 1 / (*this)(working_distance);
}

}  // namespace viewgain::detail
