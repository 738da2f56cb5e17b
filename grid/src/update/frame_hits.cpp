// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_hits.hpp"

#include <algorithm>
#include <atomic>
#include <optional>

namespace viewgain::detail {
namespace {

constexpr std::size_t kPixelChunk = 1024;

}  // namespace

void FrameHits::find(const Readings& pixels, const BlockLattice& lattice, double voxel_size,
                     const Pose& T_grid_readings, ThreadPool& pool) {
  by_pixel_.resize(pixels.size());
  pool.for_each_chunk(pixels.size(), kPixelChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      by_pixel_[i].offset = kBlockVoxels;
      if (pixels.kind(i) != PixelKind::reading) continue;
      const std::optional<Index3> voxel =
          lattice.voxel_at(T_grid_readings * pixels.point(i) / voxel_size);
      if (!voxel) continue;
      by_pixel_[i] = {lattice.key(*voxel), static_cast<std::uint32_t>(i), block_offset(*voxel)};
    }
  });

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

void FrameLines::walk(const Readings& pixels, const BlockLattice& lattice, double voxel_size,
                      const Pose& T_grid_readings, ThreadPool& pool) {
  const Eigen::Matrix3d R = T_grid_readings.rotation();
  const Eigen::Vector3d origin = T_grid_readings * pixels.origin();
  const std::vector<double>& reach_taper = pixels.reach_taper();
  marks_.resize(static_cast<std::size_t>(pool.num_threads()));
  for (LineMarks& marks : marks_) marks.clear();
  std::atomic<std::size_t> next{0};
  pool.for_each_chunk(marks_.size(), 1, [&](std::size_t worker, std::size_t) {
    for (;;) {
      const std::size_t begin = next.fetch_add(kPixelChunk, std::memory_order_relaxed);
      if (begin >= pixels.size()) return;
      for (std::size_t i = begin; i < std::min(begin + kPixelChunk, pixels.size()); ++i) {
        if (pixels.kind(i) == PixelKind::invalid) continue;
        walk_line(lattice, voxel_size,
                  {origin, R * pixels.direction(i), reach_taper[2 * i], reach_taper[2 * i + 1]},
                  marks_[worker]);
      }
    }
  });
}

std::vector<std::uint64_t> FrameLines::regions() const {
  std::vector<std::uint64_t> regions;
  for (const LineMarks& marks : marks_) {
    marks.for_each_region([&](std::uint64_t region) { regions.push_back(region); });
  }
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  return regions;
}

bool FrameLines::deltas(std::uint64_t key, std::int8_t* deltas) const {
  LineMarks::Block strongest{};
  bool any = false;
  for (const LineMarks& marks : marks_) {
    const LineMarks::Block* block = marks.find(key);
    if (block == nullptr) continue;
    any = true;
    for (std::size_t i = 0; i < kBlockVoxels; ++i)
      strongest[i] = std::max(strongest[i], (*block)[i]);
  }
  for (std::size_t i = 0; i < kBlockVoxels; ++i) {
    deltas[i] = strongest[i] == 0 ? kNoDelta : static_cast<std::int8_t>(1 - strongest[i]);
  }
  return any;
}

}  // namespace viewgain::detail
