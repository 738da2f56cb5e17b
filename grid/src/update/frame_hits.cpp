// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_hits.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "surface_at.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kHitChunk = 1024;

/// Orders the hits by block, keeping their order within each block. `scratch` is working space.
void sort_by_block(std::vector<Hit>& hits, std::vector<Hit>& scratch) {
  // Radix sort from the lowest digit: stable, and most keys have few digits that vary.
  constexpr unsigned kBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kBits;
  std::uint64_t varying = 0;
  for (const Hit& hit : hits) varying |= hit.block ^ hits.front().block;
  scratch.resize(hits.size());
  for (unsigned shift = 0; shift < 64 && varying >> shift != 0; shift += kBits) {
    if ((varying >> shift & (kBuckets - 1)) == 0) continue;
    std::array<std::uint32_t, kBuckets> position{};
    for (const Hit& hit : hits) ++position[hit.block >> shift & (kBuckets - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& p : position) {
      const std::uint32_t count = p;
      p = sum;
      sum += count;
    }
    for (const Hit& hit : hits) scratch[position[hit.block >> shift & (kBuckets - 1)]++] = hit;
    hits.swap(scratch);
  }
}

}  // namespace

void FrameHits::find(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                     bool on_surface, ThreadPool& pool) {
  const Readings& pixels = frame.readings;
  by_pixel_.resize(pixels.size());
  places_.resize(pixels.size());
  pool.for_each_chunk(pixels.size(), kHitChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      by_pixel_[i].offset = kBlockVoxels;
      if (pixels.kind(i) != PixelKind::reading) continue;
      places_[i] = frame.T_grid_readings * pixels.point(i) / voxel_size;
      std::optional<Index3> voxel = lattice.voxel_at(places_[i]);
      if (!voxel) continue;
      if (on_surface && pixels.sigmas(i).axial >= kNoisySigma * voxel_size) {
        if (const auto surface = surface_at(pixels, i)) {
          const Eigen::Vector3d place = frame.T_grid_readings * *surface / voxel_size;
          if (const auto there = lattice.voxel_at(place)) {
            places_[i] = place;
            voxel = there;
          }
        }
      }
      by_pixel_[i] = {lattice.key(*voxel), static_cast<std::uint32_t>(i), block_offset(*voxel)};
    }
  });
  sort();
}

void FrameHits::associate(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                          const BeliefGrid& map, ThreadPool& pool) {
  const double noisy = kNoisySigma * voxel_size;
  if (std::none_of(hits_.begin(), hits_.end(), [&](const Hit& hit) {
        return frame.readings.sigmas(hit.pixel).axial >= noisy;
      })) {
    return;
  }
  support_.gather(map, lattice, blocks_, hits_, pool);
  detail::associate(frame, places_, lattice, voxel_size, support_, pool, by_pixel_);
  sort();
}

void FrameHits::use_cells(const ScalePlan& plan, BeliefGrid& map) {
  if (plan.is_idle()) return;
  for (const HitBlock& block : blocks_) {
    plan.set(map, block.key);
    const int scale = scale_of(map, block.key);
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      hits_[i].offset = cell_offset(hits_[i].offset, scale);
    }
  }
}

void FrameHits::sort() {
  hits_.clear();
  for (const Hit& hit : by_pixel_) {
    if (hit.offset < kBlockVoxels) hits_.push_back(hit);
  }
  sort_by_block(hits_, scratch_);

  blocks_.clear();
  for (std::uint32_t i = 0; i < hits_.size(); ++i) {
    if (blocks_.empty() || blocks_.back().key != hits_[i].block) {
      blocks_.push_back({hits_[i].block, i, i, nullptr});
    }
    blocks_.back().end = i + 1;
  }
}

std::span<const HitBlock> FrameHits::in_region(std::uint64_t region) const {
  const auto below = [](const HitBlock& block, std::uint64_t key) { return block.key < key; };
  const auto first = std::lower_bound(blocks_.begin(), blocks_.end(), region << 6U, below);
  const auto last = std::lower_bound(first, blocks_.end(), (region + 1) << 6U, below);
  return {first, last};
}

}  // namespace viewgain::detail
