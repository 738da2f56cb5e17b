// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "line_evidence.hpp"

#include <algorithm>
#include <atomic>

#include "viewgain/support/voxel_walk.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kRayChunk = 1024;

}  // namespace

void LineMarks::clear() {
  nodes_.clear();
  last_node_ = ~std::uint64_t{0};
  last_slots_ = nullptr;
  used_ = 0;
}

LineMarks::Block& LineMarks::touch(std::uint64_t key) {
  const std::uint64_t node = key >> 12U;
  if (node != last_node_) {
    last_slots_ = &nodes_.try_emplace(node, Slots{}).first->second;
    last_node_ = node;
  }
  std::uint32_t& slot = (*last_slots_)[key & 4095U];
  if (slot == 0) {
    if (used_ == blocks_.size()) blocks_.emplace_back();
    blocks_[used_].fill(0);
    slot = static_cast<std::uint32_t>(++used_);
  }
  return blocks_[slot - 1];
}

const LineMarks::Block* LineMarks::find(std::uint64_t key) const {
  const auto node = nodes_.find(key >> 12U);
  if (node == nodes_.end()) return nullptr;
  const std::uint32_t slot = node->second[key & 4095U];
  return slot == 0 ? nullptr : &blocks_[slot - 1];
}

void walk_line(const BlockLattice& lattice, double voxel_size, const GridRay& ray,
               LineMarks& marks) {
  const HalfLine line(ray.origin / voxel_size, ray.direction);
  const auto corner = [](Index3 v) {
    return std::array<double, 3>{static_cast<double>(v.x), static_cast<double>(v.y),
                                 static_cast<double>(v.z)};
  };
  const std::array<double, 2> inside = line.inside({corner(lattice.min), corner(lattice.max)});
  const double enter = std::max(inside[0], 0.0),
               leave = std::min(inside[1], ray.reach / voxel_size);
  if (!(enter < leave)) return;
  LineMarks::Block* block = nullptr;
  Index3 in_block{};
  for (VoxelWalk walk(line, enter, lattice);
       walk.from() < leave && lattice.contains(walk.voxel());) {
    const Index3 v = walk.voxel();
    const double begin = walk.from() * voxel_size;
    if (!walk.leave<1>()) continue;
    if (block == nullptr || block_origin(v) != in_block) {
      block = &marks.touch(lattice.key(v));
      in_block = block_origin(v);
    }
    std::uint8_t& mark = (*block)[block_offset(v)];
    mark = std::max(mark, static_cast<std::uint8_t>(1 + miss_weight(ray.reach - begin, ray.taper)));
  }
}

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
