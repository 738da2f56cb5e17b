// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "evidence.hpp"
#include "readings.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// The crossings of the rays of a frame that one thread walked. A voxel's mark is 0 if no ray
/// crossed it, otherwise 1 + the weight of its strongest crossing. Marks take memory in blocks that
/// a ray entered; the memory is kept between frames.
class LineMarks {
 public:
  using Block = std::array<std::uint8_t, kBlockVoxels>;

  void clear();
  /// The block with this key; creates it if missing.
  [[nodiscard]] Block& touch(std::uint64_t key);
  [[nodiscard]] const Block* find(std::uint64_t key) const;

  /// Calls f(region key) for every region with a block, in any order.
  template <typename F>
  void for_each_region(F&& f) const {
    for (const auto& [node, slots] : nodes_) {
      for (std::uint64_t region = 0; region < 64; ++region) {
        const auto* first = slots.data() + region * 64;
        bool any = false;
        for (int i = 0; i < 64; ++i) any = any || first[i] != 0;
        if (any) f(node << 6U | region);
      }
    }
  }

 private:
  using Slots = std::array<std::uint32_t, 4096>;  ///< 1 + index in blocks_, 0: none
  std::unordered_map<std::uint64_t, Slots> nodes_;
  std::uint64_t last_node_ = ~std::uint64_t{0};
  Slots* last_slots_ = nullptr;
  std::vector<Block> blocks_;
  std::size_t used_ = 0;
};

/// A pixel's ray in the grid frame.
struct GridRay {
  Eigen::Vector3d origin;     ///< [m]
  Eigen::Vector3d direction;  ///< unit
  double reach = 0;           ///< crosses voxels that it enters before this range [m]
  double taper = 0;           ///< see miss_weight()
};

/// Walks the workspace's voxels along the ray and marks those that it crosses over a positive
/// length and enters before `reach`. The weight is that of the entry point.
void walk_line(const BlockLattice& lattice, double voxel_size, const GridRay& ray,
               LineMarks& marks);

/// Evidence by lines: a voxel is crossed if a ray passes through it before its reading. The
/// strongest crossing counts, so the result does not depend on the threads.
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
