// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "block_kernels.hpp"
#include "evidence.hpp"
#include "readings.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Bounds of squares of 2^level pixels.
class RangePyramid {
 public:
  void build(std::span<const double> reach_taper, std::int32_t width, std::int32_t height,
             ThreadPool& pool);

  /// Bounds for the pixels [u0, u1] x [v0, v1], inside the image.
  [[nodiscard]] RangeBounds bounds(std::int32_t u0, std::int32_t v0, std::int32_t u1,
                                   std::int32_t v1) const;
  /// RangeBounds::packed() of the pixels.
  [[nodiscard]] const std::uint64_t* pixels() const { return levels_[0].texels.data(); }

 private:
  struct Level {
    std::int32_t width = 0, height = 0;
    std::vector<std::uint64_t> texels;  // packed
  };
  std::vector<Level> levels_;
};

/// Classifies cubes of voxels conservatively; the block kernel makes exact decisions.
class ConeCull {
 public:
  ConeCull(const ConeCamera& camera, const RangePyramid& pyramid, double voxel_size)
      : camera_(camera), pyramid_(pyramid), voxel_size_(voxel_size) {}

  /// The cube [origin, origin + size) of voxels.
  [[nodiscard]] CubeClass classify(Index3 origin, int size) const;

 private:
  const ConeCamera& camera_;
  const RangePyramid& pyramid_;
  double voxel_size_;
};

/// Evidence by cones: a voxel is crossed if its centre projects into a pixel whose reading is
/// farther away.
class ConeEvidence {
 public:
  explicit ConeEvidence(const BlockKernels& kernels) : kernels_(kernels) {}
  ConeEvidence(const ConeEvidence&) = delete;
  ConeEvidence& operator=(const ConeEvidence&) = delete;

  /// Uses the pixels of this camera; both must live until the evidence has been used.
  void gather(const Readings& readings, const ConeCamera& camera, double voxel_size,
              ThreadPool& pool);

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
