// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "block_kernels.hpp"
#include "cone_cull.hpp"
#include "evidence.hpp"
#include "readings.hpp"

namespace viewgain::detail {

/// Evidence by cones: a voxel is crossed if its centre projects into a pixel whose reading is
/// farther away.
class ConeEvidence {
 public:
  explicit ConeEvidence(const BlockKernels& kernels) : kernels_(kernels) {}
  ConeEvidence(const ConeEvidence&) = delete;
  ConeEvidence& operator=(const ConeEvidence&) = delete;

  /// Of the pixels of this camera; both must live until the evidence has been used.
  void gather(const Readings& readings, const ConeCamera& camera, double voxel_size);

  [[nodiscard]] std::vector<std::uint64_t> regions(const BlockLattice& lattice) const;
  [[nodiscard]] CubeClass classify(Index3 origin, int size) const {
    return cull_->classify(origin, size);
  }
  [[nodiscard]] bool deltas(std::uint64_t /*key*/, Index3 origin, int scale,
                            std::int8_t* deltas) const;

 private:
  const BlockKernels& kernels_;
  const Readings* readings_ = nullptr;
  const ConeCamera* camera_ = nullptr;
  double voxel_size_ = 0;
  RangePyramid pyramid_;
  std::optional<ConeCull> cull_;
};

}  // namespace viewgain::detail
