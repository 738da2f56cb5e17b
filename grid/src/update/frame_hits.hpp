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
#include "surface_kernels.hpp"
#include "viewgain/grid/belief.hpp"
#include "viewgain/support/belief_block.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A reading and the voxel to which it counts.
struct Hit {
  std::uint64_t block = 0;  ///< BlockLattice::key
  std::uint32_t pixel = 0;
  std::uint32_t offset = 0;  ///< in the block
};

/// Hits of one block: [begin, end) of the sorted hits, and the place of its beliefs.
struct HitBlock {
  std::uint64_t key = 0;
  std::uint32_t begin = 0, end = 0;
  std::shared_ptr<const BeliefBlock>* beliefs = nullptr;
};

/// Noise from which a reading is assigned by support [voxels of sigma_ax].
inline constexpr double kNoisySigma = 0.5;

/// Number of readings per voxel: those of a frame and, in occupied voxels, of the map. Removed
/// surface is free and attracts nothing.
class VoxelSupport {
 public:
  /// Uses the map, which must not change, and the frame's hits in these blocks, sorted by key, each
  /// hit in the voxel of its position.
  void gather(const BeliefGrid& map, const BlockLattice& lattice, std::span<const HitBlock> blocks,
              std::span<const Hit> hits, ThreadPool& pool);

  /// Looks up consecutive voxels, fast within a block; use one object per thread and direction.
  class Reader {
   public:
    explicit Reader(const VoxelSupport& support) : support_(support) {}
    /// Support of the voxel's cell.
    [[nodiscard]] std::uint32_t at(Index3 voxel);
    /// Edge of the cell of the last look-up [voxels].
    [[nodiscard]] int cell() const { return 1 << scale_; }
    /// The block of the last look-up, in blocks, and a bound on the support of its cells.
    [[nodiscard]] Index3 block() const { return block_; }
    [[nodiscard]] std::uint32_t most() const { return most_; }

   private:
    const VoxelSupport& support_;
    void enter(Index3 voxel);

    /// Lowest voxel of the block divided by 8; none yet.
    Index3 block_{std::numeric_limits<std::int32_t>::max(), 0, 0};
    int scale_ = 0;                          ///< of the block
    std::uint32_t most_ = 0;                 ///< bound on the support of its cells
    const std::uint32_t* counts_ = nullptr;  ///< of the block if the frame hits it
    const BeliefBlock* beliefs_ = nullptr;   ///< otherwise its beliefs, if any,
    LeafMask occupied_{};                    ///< of its occupied voxels
  };

 private:
  using Counts = std::array<std::uint32_t, kBlockVoxels>;
  const BeliefGrid* map_ = nullptr;
  const BlockLattice* lattice_ = nullptr;
  std::vector<std::uint64_t> blocks_;  ///< blocks that the frame hits, in increasing order
  std::vector<Counts> counts_;         ///< of each of them
  std::vector<std::uint32_t> most_;    ///< largest count of each
};

/// Assigns each noisy reading to the voxel with the largest n · (1 - (t / reach)²) along its ray,
/// because noise may have moved it out of its voxel: n is the support, t the distance from the
/// reading's position in `places` [voxels], sampled in steps of half a cell; reach is 3 sigma_ax,
/// at most 8 cells. It stays in the voxel of its position unless another has more than twice its
/// value; ties go to the nearer voxel, then to the one nearer to the camera. Otherwise readings of
/// one wall would fill all voxels within their noise. `by_pixel` holds the voxel of each position.
void associate(const PlacedFrame& frame, std::span<const Eigen::Vector3d> places,
               const BlockLattice& lattice, double voxel_size, const VoxelSupport& support,
               ThreadPool& pool, std::vector<Hit>& by_pixel);

/// Readings of a frame in the workspace, by block and then by pixel.
class FrameHits {
 public:
  explicit FrameHits(const SurfaceKernels& kernels) : kernels_(kernels) {}

  /// Each reading counts to the voxel that contains it: eq. (4) of the paper. With `on_surface`
  /// noisy ones of an image count to the voxel of their place on the local surface
  /// (SurfaceKernels), unless it is outside the workspace.
  void find(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
            bool on_surface, ThreadPool& pool);
  /// After find(): noisy readings count to the best supported voxel along their ray (associate()).
  void associate(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                 const BeliefGrid& map, ThreadPool& pool);

  /// Sets the scales of the hit blocks from the plan, and assigns the hits to their cells. Refines
  /// blocks of the map.
  void use_cells(const ScalePlan& plan, BeliefGrid& map);

  [[nodiscard]] std::size_t size() const { return hits_.size(); }
  [[nodiscard]] std::span<const Hit> of(const HitBlock& block) const {
    return std::span(hits_).subspan(block.begin, block.end - block.begin);
  }
  [[nodiscard]] std::vector<HitBlock>& blocks() { return blocks_; }
  /// The blocks of one region, by key.
  [[nodiscard]] std::span<const HitBlock> in_region(std::uint64_t region) const;

 private:
  void move_to_surface(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                       ThreadPool& pool);
  void sort(ThreadPool& pool);

  const SurfaceKernels& kernels_;
  std::vector<Hit> by_pixel_;            ///< one per pixel; offset kBlockVoxels without a hit
  std::vector<Eigen::Vector3d> places_;  ///< one per pixel: assumed position [voxels]
  std::vector<Hit> hits_, scratch_;
  std::vector<HitBlock> blocks_;
  VoxelSupport support_;
};

/// The block (or null) after its hits, in order: Λ_v += Λ_r (eq. 4 of the paper), η_v += Λ_r (p_r -
/// centre), summed in double precision and rounded once (BeliefSum). A new block, because snapshots
/// may hold the old one.
[[nodiscard]] std::shared_ptr<const BeliefBlock> with_hits(
    const BeliefBlock* block, std::span<const Hit> hits, const Readings& pixels,
    const Pose& T_grid_readings, Index3 origin, double voxel_size, int scale);

}  // namespace viewgain::detail
