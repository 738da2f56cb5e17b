// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "evidence.hpp"
#include "line_marks.hpp"
#include "readings.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Evidence by lines: a voxel is crossed if a ray passes through it before its reading. The
/// strongest crossing counts. It is the same whichever thread walked the ray.
class LineEvidence {
 public:
  void gather(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
              ThreadPool& pool);

  [[nodiscard]] std::vector<std::uint64_t> regions(const BlockLattice& lattice) const;
  [[nodiscard]] static CubeClass classify(Index3 /*origin*/, int /*size*/) {
    return CubeClass::mixed;
  }
  [[nodiscard]] bool deltas(std::uint64_t key, Index3 origin, int scale, std::int8_t* deltas) const;

 private:
  std::vector<LineMarks> marks_;  ///< one per thread
};

}  // namespace viewgain::detail
