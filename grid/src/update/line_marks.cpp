// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "line_marks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::int32_t low[3] = {lattice.min.x, lattice.min.y, lattice.min.z};
  const std::int32_t high[3] = {lattice.max.x, lattice.max.y, lattice.max.z};

  double enter = 0, leave = ray.reach;
  double inverse[3];
  for (int a = 0; a < 3; ++a) {
    inverse[a] = 1.0 / ray.direction[a];
    const double near_plane = low[a] * voxel_size - ray.origin[a];
    const double far_plane = high[a] * voxel_size - ray.origin[a];
    if (ray.direction[a] == 0) {
      if (near_plane > 0 || far_plane <= 0) return;
      continue;
    }
    const double t0 = near_plane * inverse[a], t1 = far_plane * inverse[a];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (!(enter < leave)) return;

  std::int32_t voxel[3], step[3];
  double plane_t[3];
  const auto next_plane = [&](int a) {
    if (step[a] == 0) return kNever;
    const std::int32_t plane = step[a] > 0 ? voxel[a] + 1 : voxel[a];
    return (plane * voxel_size - ray.origin[a]) * inverse[a];
  };
  for (int a = 0; a < 3; ++a) {
    const double index = std::floor((ray.origin[a] + ray.direction[a] * enter) / voxel_size);
    voxel[a] = static_cast<std::int32_t>(
        std::clamp(index, static_cast<double>(low[a]), static_cast<double>(high[a] - 1)));
    step[a] = ray.direction[a] > 0 ? 1 : ray.direction[a] < 0 ? -1 : 0;
    plane_t[a] = next_plane(a);
  }

  LineMarks::Block* block = nullptr;
  Index3 in_block{};
  while (enter < leave) {
    int axis = plane_t[0] <= plane_t[1] ? 0 : 1;
    if (plane_t[2] < plane_t[axis]) axis = 2;
    if (plane_t[axis] > enter) {  // a stretch of positive length
      const Index3 v{voxel[0], voxel[1], voxel[2]};
      if (block == nullptr || block_origin(v) != in_block) {
        block = &marks.touch(lattice.key(v));
        in_block = block_origin(v);
      }
      std::uint8_t& mark = (*block)[block_offset(v)];
      mark =
          std::max(mark, static_cast<std::uint8_t>(1 + miss_weight(ray.reach - enter, ray.taper)));
      enter = plane_t[axis];
    }
    voxel[axis] += step[axis];
    if (voxel[axis] < low[axis] || voxel[axis] >= high[axis]) return;
    plane_t[axis] = next_plane(axis);
  }
}

}  // namespace viewgain::detail
