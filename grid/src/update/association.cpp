// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "association.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace viewgain::detail {
namespace {

constexpr std::size_t kPixelChunk = 1024, kBlockChunk = 16;
constexpr double kStep = 0.5;    // along the ray [cells]
constexpr double kMargin = 2.0;  // by which another voxel must be better
constexpr double kFarthest = 8;  // that is looked at; bounds the cost [cells]

}  // namespace

void VoxelSupport::gather(const BeliefGrid& map, const BlockLattice& lattice,
                          std::span<const HitBlock> blocks, std::span<const Hit> hits,
                          ThreadPool& pool) {
  map_ = &map;
  lattice_ = &lattice;
  blocks_.resize(blocks.size());
  counts_.resize(blocks.size());
  const BeliefMap& beliefs = beliefs_of(map);
  pool.for_each_chunk(blocks.size(), kBlockChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      blocks_[i] = blocks[i].key;
      Counts& counts = counts_[i];
      counts.fill(0);
      for (std::uint32_t h = blocks[i].begin; h < blocks[i].end; ++h) ++counts[hits[h].offset];
      const auto found = beliefs.find(blocks[i].key);
      if (found == beliefs.end()) continue;
      for_each_bit(occupied_in(map, lattice.origin(blocks[i].key)), [&](unsigned offset) {
        const Belief* belief = found->second->find(offset);
        if (belief == nullptr) return;
        constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
        counts[offset] += std::min(belief->hits, kMost - counts[offset]);
      });
    }
  });
}

void VoxelSupport::Reader::enter(Index3 voxel) {
  const std::uint64_t block = support_.lattice_->key(voxel);
  scale_ = scale_of(*support_.map_, block);
  counts_ = nullptr;
  beliefs_ = nullptr;
  const std::vector<std::uint64_t>& blocks = support_.blocks_;
  const auto found = std::lower_bound(blocks.begin(), blocks.end(), block);
  if (found != blocks.end() && *found == block) {
    counts_ = support_.counts_[static_cast<std::size_t>(found - blocks.begin())].data();
    return;
  }
  const BeliefMap& beliefs = beliefs_of(*support_.map_);
  if (const auto of_map = beliefs.find(block); of_map != beliefs.end()) {
    beliefs_ = of_map->second.get();
    occupied_ = occupied_in(*support_.map_, support_.lattice_->origin(block));
  }
}

std::uint32_t VoxelSupport::Reader::at(Index3 voxel) {
  const Index3 block{voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
  if (!(block == block_)) {
    block_ = block;
    enter(voxel);
  }
  const unsigned offset = cell_offset(block_offset(voxel), scale_);
  if (counts_ != nullptr) return counts_[offset];
  if (beliefs_ == nullptr || !test_bit(occupied_, offset)) return 0;
  const Belief* belief = beliefs_->find(offset);
  return belief != nullptr ? belief->hits : 0;
}

void associate(const PlacedFrame& frame, std::span<const Eigen::Vector3d> places,
               const BlockLattice& lattice, double voxel_size, const VoxelSupport& support,
               ThreadPool& pool, std::vector<Hit>& by_pixel) {
  const Readings& pixels = frame.readings;
  const Eigen::Matrix3d R_grid_readings = frame.T_grid_readings.rotation();
  pool.for_each_chunk(by_pixel.size(), kPixelChunk, [&](std::size_t begin, std::size_t end) {
    VoxelSupport::Reader before(support), behind(support);
    for (std::size_t i = begin; i < end; ++i) {
      Hit& hit = by_pixel[i];
      if (hit.offset >= kBlockVoxels) continue;
      const double sigma = pixels.sigmas(i).axial / voxel_size;
      if (sigma < kNoisySigma) continue;
      const Eigen::Vector3d& p = places[i];
      const Index3 own = *lattice.voxel_at(p);
      const Eigen::Vector3d direction = R_grid_readings * pixels.direction(i);
      const double range = (pixels.point(i) - pixels.origin()).norm() / voxel_size;
      double best = kMargin * before.at(own);
      const double cell = before.cell();
      if (sigma < kNoisySigma * cell) continue;
      const double reach = std::min(kTaperSigmas * sigma, kFarthest * cell);
      // A voxel is worth most where its side's first look falls into it.
      Index3 last_before = own, last_behind = own;
      const auto look = [&](double t, VoxelSupport::Reader& reader, Index3& last) {
        const std::optional<Index3> voxel = lattice.voxel_at(p + t * direction);
        if (!voxel || *voxel == last) return;
        last = *voxel;
        const double value = reader.at(*voxel) * (1 - t / reach * (t / reach));
        if (value <= best) return;
        best = value;
        hit.block = lattice.key(*voxel);
        hit.offset = block_offset(*voxel);
      };
      for (int step = 1; step * kStep * cell < reach; ++step) {
        const double t = step * kStep * cell;
        if (t < range) look(-t, before, last_before);
        look(t, behind, last_behind);
      }
    }
  });
}

}  // namespace viewgain::detail
