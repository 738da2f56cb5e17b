// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "open_directions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "viewgain/support/belief_block.hpp"

namespace viewgain::detail {

OpenDirections::OpenDirections(const GridSnapshot& snapshot, const VoxelBox& cells, int shift,
                               const FreeShare& free, int reach)
    : size_{static_cast<std::size_t>(cells.max.x - cells.min.x),
            static_cast<std::size_t>(cells.max.y - cells.min.y),
            static_cast<std::size_t>(cells.max.z - cells.min.z)},
      words_((size_[2] + 63) / 64 + 1) {
  const std::size_t rows = size_[0] * size_[1];
  const std::size_t all = rows * words_ + 2;  // one more before and behind, as shifts look there
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
    // The bits of `wanted` from the second on: twice as far, and one step more where there is one.
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

// `first` from each cell, then `then` from where that ends, `steps` on. A row's last word is kept
// at 0, so that what is shifted from one row into the next is lost.
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
    // Compilers make vectors of this where the shift is a constant of the loop.
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
