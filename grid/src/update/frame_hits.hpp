// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "map/block_lattice.hpp"
#include "readings.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/grid/belief.hpp"

namespace viewgain::detail {

/// A reading and the voxel that encloses it.
struct Hit {
  std::uint64_t block = 0;  ///< BlockLattice::key
  std::uint32_t pixel = 0;
  std::uint32_t offset = 0;  ///< in the block
};

/// The hits of one block: [begin, end) of the sorted hits, and where its beliefs are kept.
struct HitBlock {
  std::uint64_t key = 0;
  std::uint32_t begin = 0, end = 0;
  std::shared_ptr<const BeliefBlock>* beliefs = nullptr;
};

/// Readings of a frame that lie in the workspace, by block and within a block in pixel order.
class FrameHits {
 public:
  void find(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
            ThreadPool& pool);

  [[nodiscard]] std::size_t size() const { return hits_.size(); }
  [[nodiscard]] std::span<const Hit> of(const HitBlock& block) const {
    return std::span(hits_).subspan(block.begin, block.end - block.begin);
  }
  [[nodiscard]] std::vector<HitBlock>& blocks() { return blocks_; }
  /// The blocks of one region, by key.
  [[nodiscard]] std::span<const HitBlock> in_region(std::uint64_t region) const;

 private:
  std::vector<Hit> by_pixel_;  ///< one a pixel; offset kBlockVoxels where there is no hit
  std::vector<Hit> hits_, scratch_;
  std::vector<HitBlock> blocks_;
};

}  // namespace viewgain::detail
