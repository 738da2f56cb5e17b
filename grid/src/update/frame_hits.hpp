// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "belief_merge.hpp"
#include "line_marks.hpp"
#include "map/block_lattice.hpp"
#include "readings.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain::detail {

/// The hits of one block: [begin, end) of the sorted hits, and where its beliefs are kept.
struct HitBlock {
  std::uint64_t key = 0;
  std::uint32_t begin = 0, end = 0;
  std::shared_ptr<const BeliefBlock>* beliefs = nullptr;
};

/// Readings of a frame that lie in the workspace, by block and within a block in pixel order.
class FrameHits {
 public:
  void find(const Readings& pixels, const BlockLattice& lattice, double voxel_size,
            const Pose& T_grid_readings, ThreadPool& pool);

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

/// Walks the rays of all pixels, each thread with marks of its own; a voxel's strongest mark does
/// not depend on who made it.
class FrameLines {
 public:
  void walk(const Readings& pixels, const BlockLattice& lattice, double voxel_size,
            const Pose& T_grid_readings, ThreadPool& pool);

  /// Regions with a mark, in rising order.
  [[nodiscard]] std::vector<std::uint64_t> regions() const;
  /// Sets deltas from the strongest marks of a block; false if there are none.
  [[nodiscard]] bool deltas(std::uint64_t key, std::int8_t* deltas) const;

 private:
  std::vector<LineMarks> marks_;
};

}  // namespace viewgain::detail
