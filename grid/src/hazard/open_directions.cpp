// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "open_directions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "viewgain/support/belief_block.hpp"

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

// Marks the free cells; a cell cut by the workspace's faces counts by its part inside.
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

// Sums of 7 along an axis, with the first and last cells repeated beyond the ends: `count` rows of
// `stride` adjacent cells.
void FreeShare::add_up(std::size_t stride, std::size_t count) {
  const std::vector<std::int32_t> in =
      std::exchange(sums_, std::vector<std::int32_t>(sums_.size()));
  std::vector<std::int32_t> sum(stride);
  for (std::size_t outer = 0; outer < in.size(); outer += stride * count) {
    const auto row = [&](std::size_t i) {  // the first value is repeated kAround times
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

OpenDirections::OpenDirections(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                               const FreeShare& free, int reach)
    : size_{static_cast<std::size_t>(cells.max.x - cells.min.x),
            static_cast<std::size_t>(cells.max.y - cells.min.y),
            static_cast<std::size_t>(cells.max.z - cells.min.z)},
      words_((size_[2] + 63) / 64 + 1) {
  const std::size_t rows = size_[0] * size_[1];
  const std::size_t all = rows * words_ + 2;  // one more on each side, because shifts read there
  Steps here{Bits(all), Bits(all)};
  const Steps none{Bits(all), Bits(all, ~std::uint64_t{0})};
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t z = 0; z < size_[2]; ++z) {
      const std::uint64_t bit = std::uint64_t{1} << (z % 64);
      (free.is_free(row * size_[2] + z) ? here.free : here.unknown)[word_of(row, z)] |= bit;
    }
  }
  const int edge = 1 << shift;
  const VoxelBox voxels{{cells.min.x * edge, cells.min.y * edge, cells.min.z * edge},
                        {cells.max.x * edge, cells.max.y * edge, cells.max.z * edge}};
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    for_each_bit(leaf.occupied, [&](unsigned offset) {
      const Index3 v = offset_voxel(leaf.origin, offset);
      if (!voxels.contains(v)) return;
      const auto x = static_cast<std::size_t>((v.x >> shift) - cells.min.x),
                 y = static_cast<std::size_t>((v.y >> shift) - cells.min.y),
                 z = static_cast<std::size_t>((v.z >> shift) - cells.min.z);
      here.unknown[word_of(x * size_[1] + y, z)] &= ~(std::uint64_t{1} << (z % 64));
    });
  }
  for (Bits& plane : counts_) plane.assign(all, 0);
  for (int i = 0; i < 27; ++i) {
    const Direction by{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
    const int squared = by[0] * by[0] + by[1] * by[1] + by[2] * by[2];
    if (squared == 0) continue;
    const auto wanted =
        static_cast<unsigned>(std::max(1.0, reach / std::sqrt(double{1} * squared)));
    const Steps one = joined(none, here, by, 1);
    Steps steps = one;
    // The bits of `wanted` from the second on: doubles the distance, plus one step for a set bit.
    int taken = 1;
    for (int bit = std::bit_width(wanted) - 2; bit >= 0; --bit) {
      steps = joined(steps, steps, by, taken);
      taken *= 2;
      if ((wanted >> bit & 1U) != 0) {
        steps = joined(one, steps, by, 1);
        ++taken;
      }
    }
    add(steps.free);
  }
}

// `first` from each cell, then `then` from its end, `steps` further. The last word of a row stays
// 0, so that bits shifted from one row into the next are lost.
OpenDirections::Steps OpenDirections::joined(const Steps& first, const Steps& then,
                                             const Direction& by, int steps) const {
  Steps result{first.free, Bits(first.unknown.size())};
  const int nx = static_cast<int>(size_[0]), ny = static_cast<int>(size_[1]);
  const int dx = by[0] * steps, dy = by[1] * steps, dz = by[2] * steps;
  const int low = std::max(0, -dy), high = std::min(ny, ny - dy);
  if (low >= high) return result;
  const std::size_t count = static_cast<std::size_t>(high - low) * words_;
  for (int x = std::max(0, -dx); x < std::min(nx, nx - dx); ++x) {
    const std::size_t here = word_of(static_cast<std::size_t>(x * ny + low), 0),
                      there = word_of(static_cast<std::size_t>((x + dx) * ny + low + dy), 0);
    // Compilers vectorise this if the shift is a loop constant.
    const auto join = [&](auto&& shifted) {
      for (std::size_t w = 0; w < count; ++w) {
        const std::uint64_t passed = first.unknown[here + w];
        result.free[here + w] |= passed & shifted(then.free, there + w);
        result.unknown[here + w] = passed & shifted(then.unknown, there + w);
      }
    };
    const auto shift = static_cast<unsigned>(std::abs(dz)), rest = 64 - shift;
    if (dz == 0) {
      join([](const Bits& bits, std::size_t w) { return bits[w]; });
    } else if (dz > 0) {
      join([=](const Bits& bits, std::size_t w) { return bits[w] >> shift | bits[w + 1] << rest; });
    } else {
      join([=](const Bits& bits, std::size_t w) { return bits[w] << shift | bits[w - 1] >> rest; });
    }
  }
  for (std::size_t row = 1; row <= size_[0] * size_[1]; ++row) {
    const std::size_t last = word_of(row, 0) - 1;
    result.free[last] = result.unknown[last] = 0;
  }
  return result;
}

void OpenDirections::add(const Bits& bits) {
  for (std::size_t i = 0; i < bits.size(); ++i) {
    std::uint64_t carry = bits[i];
    for (Bits& plane : counts_) {
      const std::uint64_t both = plane[i] & carry;
      plane[i] ^= carry;
      carry = both;
    }
  }
}

}  // namespace viewgain::detail
