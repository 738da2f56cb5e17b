// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "association.hpp"
#include "hit.hpp"
#include "readings.hpp"
#include "scale_plan.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// Readings of a frame that lie in the workspace, by block and within a block in pixel order.
class FrameHits {
 public:
  /// Each reading counts for the voxel that it lies in: the paper's eq. (4). With `on_surface`
  /// noisy ones count for that of their surface_at(), unless it is outside the workspace.
  void find(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
            bool on_surface, ThreadPool& pool);
  /// After find(): noisy readings count for the best supported voxel along their ray (associate()).
  void associate(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                 const BeliefGrid& map, ThreadPool& pool);

  /// Gives the blocks that are hit the scales of the plan, and the hits to their cells. Blocks of
  /// the map become finer by it.
  void use_cells(const ScalePlan& plan, BeliefGrid& map);

  [[nodiscard]] std::size_t size() const { return hits_.size(); }
  [[nodiscard]] std::span<const Hit> of(const HitBlock& block) const {
    return std::span(hits_).subspan(block.begin, block.end - block.begin);
  }
  [[nodiscard]] std::vector<HitBlock>& blocks() { return blocks_; }
  /// The blocks of one region, by key.
  [[nodiscard]] std::span<const HitBlock> in_region(std::uint64_t region) const;

 private:
  void sort();

  std::vector<Hit> by_pixel_;            ///< one a pixel; offset kBlockVoxels where there is no hit
  std::vector<Eigen::Vector3d> places_;  ///< one a pixel, where it is taken to be [voxels]
  std::vector<Hit> hits_, scratch_;
  std::vector<HitBlock> blocks_;
  VoxelSupport support_;
};

}  // namespace viewgain::detail
