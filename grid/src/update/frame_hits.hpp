// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "map/belief_blocks.hpp"
#include "readings.hpp"
#include "scale_plan.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A reading and the voxel that it counts for.
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

/// Readings that are at least this noisy look for support [voxels of sigma_ax].
inline constexpr double kNoisySigma = 0.5;

/// How many readings each voxel has: those of a frame and, where the map has it occupied, those of
/// the map. Surface that has gone is free, and attracts nothing.
class VoxelSupport {
 public:
  /// Of the map, which must stay as it is, and of the frame's hits in these blocks, sorted by key,
  /// each hit in its place's voxel.
  void gather(const BeliefGrid& map, const BlockLattice& lattice, std::span<const HitBlock> blocks,
              std::span<const Hit> hits, ThreadPool& pool);

  /// Looks up voxel after voxel, quickly in the same block; one for each thread and way.
  class Reader {
   public:
    explicit Reader(const VoxelSupport& support) : support_(support) {}
    /// Of the voxel's cell.
    [[nodiscard]] std::uint32_t at(Index3 voxel);
    /// An edge of the cell that was looked at last [voxels].
    [[nodiscard]] int cell() const { return 1 << scale_; }

   private:
    const VoxelSupport& support_;
    void enter(Index3 voxel);

    /// Voxels of the block by their least, divided by 8; none yet.
    Index3 block_{std::numeric_limits<std::int32_t>::max(), 0, 0};
    int scale_ = 0;                          ///< of the block
    const std::uint32_t* counts_ = nullptr;  ///< of the block, where the frame hits it
    const BeliefBlock* beliefs_ = nullptr;   ///< else its beliefs, if it has any,
    LeafMask occupied_{};                    ///< of its occupied voxels
  };

 private:
  using Counts = std::array<std::uint32_t, kBlockVoxels>;
  const BeliefGrid* map_ = nullptr;
  const BlockLattice* lattice_ = nullptr;
  std::vector<std::uint64_t> blocks_;  ///< that the frame hits, in rising order
  std::vector<Counts> counts_;         ///< of each of them
};

/// Gives each noisy reading, which noise may have carried out of its voxel, to the voxel with the
/// largest n · (1 - (t / reach)²): n its support, t the distance from the reading's place, one of
/// `places` [voxels], along the ray, sought at half cells' steps, reach 3 sigma_ax, at most 8
/// cells. It stays in its place's voxel unless another has more than twice its value; of equal
/// ones the nearer counts, then the one nearer to the camera. Else the readings of one wall would
/// fill all voxels within their noise. `by_pixel` holds the voxel of each place.
void associate(const PlacedFrame& frame, std::span<const Eigen::Vector3d> places,
               const BlockLattice& lattice, double voxel_size, const VoxelSupport& support,
               ThreadPool& pool, std::vector<Hit>& by_pixel);

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

/// The block (may be null) after the hits, all its own, in their order: Λ_v += Λ_r (the paper's eq.
/// 4), η_v += Λ_r (p_r - centre), summed in double precision and rounded once (BeliefSum). A new
/// block: snapshots may hold the old one.
[[nodiscard]] std::shared_ptr<const BeliefBlock> with_hits(
    const BeliefBlock* block, std::span<const Hit> hits, const Readings& pixels,
    const Pose& T_grid_readings, Index3 origin, double voxel_size, int scale);

}  // namespace viewgain::detail
