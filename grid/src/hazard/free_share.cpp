// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "free_share.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {
namespace {

constexpr int kAround = 3;  // cells on each side

// Voxels of a cell that lie in [min, max), along an axis.
int overlap(int cell, int edge, int min, int max) {
  return std::min(cell + edge, max) - std::max(cell, min);
}

}  // namespace

FreeShare::FreeShare(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                     ThreadPool& pool)
    : cells_(cells),
      shift_(shift),
      size_{cells.max.x - cells.min.x, cells.max.y - cells.min.y, cells.max.z - cells.min.z},
      sums_(std::make_unique_for_overwrite<std::uint16_t[]>(cells.volume())),
      is_free_(std::make_unique_for_overwrite<std::uint8_t[]>(cells.volume())) {
  const auto planes = static_cast<std::size_t>(size_[0]);
  pool.for_each_chunk(planes, 4, [&](std::size_t begin, std::size_t end) {
    std::fill(&sums_[begin * index(1, 0, 0)], &sums_[0] + end * index(1, 0, 0),
              static_cast<std::uint16_t>(1U << (3 * shift)));
  });
  subtract_leaves(snapshot, pool);
  const VoxelBox workspace = VoxelBox::from_dims(snapshot.min_index, snapshot.dims);
  pool.for_each_chunk(planes, 1, [&](std::size_t plane, std::size_t) {
    const auto x = static_cast<int>(plane);
    subtract_tiles(snapshot, x);
    settle(workspace, x);
    add_up_rows(x);
  });
}

VoxelBox FreeShare::voxels_of(int x) const {
  const int edge = 1 << shift_;
  return {{(cells_.min.x + x) * edge, cells_.min.y * edge, cells_.min.z * edge},
          {(cells_.min.x + x + 1) * edge, cells_.max.y * edge, cells_.max.z * edge}};
}

// Leaves share no cell.
void FreeShare::subtract_leaves(const GridSnapshot& snapshot, ThreadPool& pool) {
  const int edge = 1 << shift_;
  const unsigned in_cell = (1U << edge) - 1U;
  const auto is_inside = [](int i, int size) { return i >= 0 && i < size; };
  const auto subtract = [&](const GridSnapshot::Leaf& leaf) {
    const Index3 low{(leaf.origin.x >> shift_) - cells_.min.x,
                     (leaf.origin.y >> shift_) - cells_.min.y,
                     (leaf.origin.z >> shift_) - cells_.min.z};
    for (int i = 0; i < 64; ++i) {  // rows of 8 voxels along z
      const int x = low.x + (i >> 3 >> shift_), y = low.y + ((i & 7) >> shift_);
      const auto row = static_cast<unsigned>(
          leaf.non_free[static_cast<std::size_t>(i >> 3)] >> (8 * (i & 7)) & 0xFFU);
      if (row == 0 || !is_inside(x, size_[0]) || !is_inside(y, size_[1])) continue;
      for (int from = 0; from < 8; from += edge) {
        const int z = low.z + (from >> shift_), count = std::popcount(row >> from & in_cell);
        if (count == 0 || !is_inside(z, size_[2])) continue;
        std::uint16_t& sum = sums_[index(x, y, z)];
        sum = static_cast<std::uint16_t>(sum - count);
      }
    }
  };
  pool.for_each_chunk(snapshot.leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::for_each(snapshot.leaves.begin() + std::ptrdiff_t(begin),
                  snapshot.leaves.begin() + std::ptrdiff_t(end), subtract);
  });
}

void FreeShare::subtract_tiles(const GridSnapshot& snapshot, int plane) {
  const VoxelBox voxels = voxels_of(plane);
  const int edge = 1 << shift_;
  for (const VoxelBox& tile : snapshot.tiles) {
    const VoxelBox unknown = tile.intersection(voxels);
    if (unknown.volume() == 0) continue;
    const int across_x = unknown.max.x - unknown.min.x;
    for (int y = unknown.min.y & -edge; y < unknown.max.y; y += edge) {
      const int across = across_x * overlap(y, edge, unknown.min.y, unknown.max.y);
      for (int z = unknown.min.z & -edge; z < unknown.max.z; z += edge) {
        std::uint16_t& sum =
            sums_[index(plane, (y >> shift_) - cells_.min.y, (z >> shift_) - cells_.min.z)];
        sum = static_cast<std::uint16_t>(sum -
                                         across * overlap(z, edge, unknown.min.z, unknown.max.z));
      }
    }
  }
}

// Marks the free cells; a cell cut by the workspace's faces counts by its part inside.
void FreeShare::settle(const VoxelBox& workspace, int plane) {
  const int edge = 1 << shift_, all = 1 << (3 * shift_);
  const VoxelBox voxels = voxels_of(plane);
  const std::size_t first = index(plane, 0, 0), last = index(plane + 1, 0, 0);
  if (voxels.intersection(workspace).volume() == voxels.volume()) {
    for (std::size_t i = first; i < last; ++i) is_free_[i] = sums_[i] == all ? 1 : 0;
    return;
  }
  std::size_t i = first;
  for (int y = voxels.min.y; y < voxels.max.y; y += edge) {
    for (int z = voxels.min.z; z < voxels.max.z; z += edge, ++i) {
      const VoxelBox cell = VoxelBox::from_dims({voxels.min.x, y, z}, {edge, edge, edge});
      const auto inside = static_cast<int>(cell.intersection(workspace).volume());
      const int free = sums_[i] - (all - inside);
      is_free_[i] = free == inside ? 1 : 0;
      sums_[i] = static_cast<std::uint16_t>(inside > 0 ? free * all / inside : 0);
    }
  }
}

// Sums of 7 along z, with the first and last cells repeated beyond the ends.
void FreeShare::add_up_rows(int x) {
  const int count = size_[2];
  std::vector<int> padded(static_cast<std::size_t>(count + 2 * kAround));
  for (int y = 0; y < size_[1]; ++y) {
    std::uint16_t* row = &sums_[index(x, y, 0)];
    std::fill_n(padded.begin(), kAround, row[0]);
    std::copy_n(row, count, padded.begin() + kAround);
    std::fill_n(padded.end() - kAround, kAround, row[count - 1]);
    const int* p = padded.data();
    for (int z = 0; z < count; ++z, ++p) {
      row[z] = static_cast<std::uint16_t>(p[0] + p[1] + p[2] + p[3] + p[4] + p[5] + p[6]);
    }
  }
}

// The 7³ cells around one neighbour, less those around the other: most are the same.
Eigen::Vector3d FreeShare::gradient(int x, int y, int z) const {
  constexpr int kReach = kAround + 1;
  std::array<std::size_t, 2 * kReach + 1> row_x{}, row_y{};
  for (int i = -kReach; i <= kReach; ++i) {
    const auto at = static_cast<std::size_t>(i + kReach);
    row_x[at] = index(std::clamp(x + i, 0, size_[0] - 1), 0, 0);
    row_y[at] = index(0, std::clamp(y + i, 0, size_[1] - 1), 0);
  }
  const auto sum = [&](int i, int j, int k) {
    return int{sums_[row_x[static_cast<std::size_t>(i + kReach)] +
                     row_y[static_cast<std::size_t>(j + kReach)] + static_cast<std::size_t>(k)]};
  };
  // What enters from one neighbour to the other, less what leaves.
  const auto difference = [](int at, int size, const auto& slab) {
    const int low = at > 0 ? -1 : 0, high = at + 1 < size ? 1 : 0;
    int result = 0;
    for (int s = 0; s < high - low; ++s) {
      for (int k = -kAround; k <= kAround; ++k) {
        result += slab(high + kAround - s, k) - slab(low - kAround + s, k);
      }
    }
    return static_cast<double>(result);
  };
  const int below = std::max(z - 1, 0), above = std::min(z + 1, size_[2] - 1);
  int along_z = 0;
  for (int i = -kAround; i <= kAround; ++i) {
    for (int j = -kAround; j <= kAround; ++j) along_z += sum(i, j, above) - sum(i, j, below);
  }
  return {difference(x, size_[0], [&](int i, int j) { return sum(i, j, z); }),
          difference(y, size_[1], [&](int j, int i) { return sum(i, j, z); }),
          static_cast<double>(along_z)};
}

}  // namespace viewgain::detail
