// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "line_marks.hpp"

#include <algorithm>
#include <array>

#include "viewgain/support/voxel_walk.hpp"

namespace viewgain::detail {

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

}  // namespace viewgain::detail
