// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "line_evidence.hpp"

#include <algorithm>
#include <atomic>

namespace viewgain::detail {
namespace {

constexpr std::size_t kRayChunk = 1024;

}  // namespace

void LineEvidence::gather(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                          ThreadPool& pool) {
  const Readings& readings = frame.readings;
  const Eigen::Matrix3d R = frame.T_grid_readings.rotation();
  const Eigen::Vector3d origin = frame.T_grid_readings * readings.origin();
  const std::vector<double>& reach_taper = readings.reach_taper();
  marks_.resize(static_cast<std::size_t>(pool.num_threads()));
  for (LineMarks& marks : marks_) marks.clear();
  std::atomic<std::size_t> next{0};
  pool.for_each_chunk(marks_.size(), 1, [&](std::size_t worker, std::size_t) {
    for (;;) {
      const std::size_t begin = next.fetch_add(kRayChunk, std::memory_order_relaxed);
      if (begin >= readings.size()) return;
      for (std::size_t i = begin; i < std::min(begin + kRayChunk, readings.size()); ++i) {
        if (readings.kind(i) == PixelKind::invalid) continue;
        walk_line(lattice, voxel_size,
                  {origin, R * readings.direction(i), reach_taper[2 * i], reach_taper[2 * i + 1]},
                  marks_[worker]);
      }
    }
  });
}

std::vector<std::uint64_t> LineEvidence::regions(const BlockLattice& /*lattice*/) const {
  std::vector<std::uint64_t> regions;
  for (const LineMarks& marks : marks_) {
    marks.for_each_region([&](std::uint64_t region) { regions.push_back(region); });
  }
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  return regions;
}

bool LineEvidence::deltas(std::uint64_t key, Index3 /*origin*/, int scale,
                          std::int8_t* deltas) const {
  LineMarks::Block strongest{};
  bool any = false;
  for (const LineMarks& marks : marks_) {
    const LineMarks::Block* block = marks.find(key);
    if (block == nullptr) continue;
    any = true;
    for (std::size_t i = 0; i < kBlockVoxels; ++i)
      strongest[i] = std::max(strongest[i], (*block)[i]);
  }
  for (unsigned i = 0; any && scale > 0 && i < kBlockVoxels; ++i) {
    std::uint8_t& of_cell = strongest[cell_offset(i, scale)];
    of_cell = std::max(of_cell, strongest[i]);
  }
  for (unsigned i = 0; i < kBlockVoxels; ++i) {
    strongest[i] = strongest[cell_offset(i, scale)];
    deltas[i] = strongest[i] == 0 ? kNoDelta : static_cast<std::int8_t>(1 - strongest[i]);
  }
  return any;
}

}  // namespace viewgain::detail
