// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "free_share.hpp"

#include <algorithm>
#include <utility>

namespace viewgain::detail {
namespace {

constexpr std::size_t kAround = 3;  // cells on each side

}  // namespace

FreeShare::FreeShare(const GridSnapshot& snapshot, const VoxelBox& cells, int shift)
    : cells_(cells),
      size_{cells.max.x - cells.min.x, cells.max.y - cells.min.y, cells.max.z - cells.min.z},
      sums_(cells.volume(), std::int32_t{1} << (3 * shift)) {
  count(snapshot, shift);
  settle(VoxelBox::from_dims(snapshot.min_index, snapshot.dims), shift);
  const auto [x, y, z] = size_;
  const auto depth = static_cast<std::size_t>(z), plane = static_cast<std::size_t>(y) * depth;
  add_up(1, depth);
  add_up(depth, static_cast<std::size_t>(y));
  add_up(plane, static_cast<std::size_t>(x));
}

void FreeShare::count(const GridSnapshot& snapshot, int shift) {
  const VoxelBox voxels{{cells_.min.x << shift, cells_.min.y << shift, cells_.min.z << shift},
                        {cells_.max.x << shift, cells_.max.y << shift, cells_.max.z << shift}};
  const auto cell_of = [&](Index3 v) -> std::int32_t& {
    const Index3 c{(v.x >> shift) - cells_.min.x, (v.y >> shift) - cells_.min.y,
                   (v.z >> shift) - cells_.min.z};
    return sums_[static_cast<std::size_t>((c.x * size_[1] + c.y) * std::ptrdiff_t{size_[2]} + c.z)];
  };
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    if (VoxelBox::from_dims(leaf.origin, {8, 8, 8}).intersection(voxels).volume() == 0) continue;
    for_each_bit(leaf.non_free, [&](unsigned offset) {
      const Index3 v = offset_voxel(leaf.origin, offset);
      if (voxels.contains(v)) --cell_of(v);
    });
  }
  const int edge = 1 << shift;
  for (const VoxelBox& tile : snapshot.tiles) {
    const VoxelBox unknown = tile.intersection(voxels);
    if (unknown.volume() == 0) continue;
    for (int x = unknown.min.x & -edge; x < unknown.max.x; x += edge) {
      for (int y = unknown.min.y & -edge; y < unknown.max.y; y += edge) {
        for (int z = unknown.min.z & -edge; z < unknown.max.z; z += edge) {
          const VoxelBox cell = VoxelBox::from_dims({x, y, z}, {edge, edge, edge});
          cell_of({x, y, z}) -= static_cast<std::int32_t>(cell.intersection(unknown).volume());
        }
      }
    }
  }
}

// Marks the free cells, and takes the workspace's part of a cell that its faces cut for the whole.
void FreeShare::settle(const VoxelBox& workspace, int shift) {
  const int edge = 1 << shift;
  const std::int32_t all = std::int32_t{1} << (3 * shift);
  is_free_.reserve(sums_.size());
  const VoxelBox voxels{{cells_.min.x * edge, cells_.min.y * edge, cells_.min.z * edge},
                        {cells_.max.x * edge, cells_.max.y * edge, cells_.max.z * edge}};
  if (voxels.intersection(workspace).volume() == voxels.volume()) {
    for (const std::int32_t free : sums_) is_free_.push_back(free == all ? 1 : 0);
    return;
  }
  std::size_t i = 0;
  for (int x = cells_.min.x; x < cells_.max.x; ++x) {
    for (int y = cells_.min.y; y < cells_.max.y; ++y) {
      for (int z = cells_.min.z; z < cells_.max.z; ++z, ++i) {
        const VoxelBox cell =
            VoxelBox::from_dims({x * edge, y * edge, z * edge}, {edge, edge, edge});
        const auto inside = static_cast<std::int32_t>(cell.intersection(workspace).volume());
        const std::int32_t free = sums_[i] - (all - inside);
        is_free_.push_back(free == inside ? 1 : 0);
        sums_[i] = inside > 0 ? free * all / inside : 0;
      }
    }
  }
}

// Sums of 7 along an axis, of which the first and last go on beyond the ends: of rows of `stride`
// cells side by side, `count` of them one after another.
void FreeShare::add_up(std::size_t stride, std::size_t count) {
  const std::vector<std::int32_t> in =
      std::exchange(sums_, std::vector<std::int32_t>(sums_.size()));
  std::vector<std::int32_t> sum(stride);
  for (std::size_t outer = 0; outer < in.size(); outer += stride * count) {
    const auto row = [&](std::size_t i) {  // kAround before the first is 0
      return &in[outer + std::min(std::max(i, kAround) - kAround, count - 1) * stride];
    };
    std::fill(sum.begin(), sum.end(), 0);
    for (std::size_t i = 0; i < 2 * kAround; ++i) {
      for (std::size_t j = 0; j < stride; ++j) sum[j] += row(i)[j];
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t *first = row(i), *last = row(i + 2 * kAround);
      std::int32_t* out = &sums_[outer + i * stride];
      for (std::size_t j = 0; j < stride; ++j) {
        out[j] = sum[j] + last[j];
        sum[j] = out[j] - first[j];
      }
    }
  }
}

Eigen::Vector3d FreeShare::gradient(int x, int y, int z) const {
  const auto sum = [&](int i, int j, int k) {
    const auto within = [](int v, int size) { return std::clamp(v, 0, size - 1); };
    return sums_[static_cast<std::size_t>((within(i, size_[0]) * size_[1] + within(j, size_[1])) *
                                              std::ptrdiff_t{size_[2]} +
                                          within(k, size_[2]))];
  };
  return {static_cast<double>(sum(x + 1, y, z) - sum(x - 1, y, z)),
          static_cast<double>(sum(x, y + 1, z) - sum(x, y - 1, z)),
          static_cast<double>(sum(x, y, z + 1) - sum(x, y, z - 1))};
}

}  // namespace viewgain::detail
