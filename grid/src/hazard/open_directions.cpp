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
      words_((size_[2] + 63) / 64) {
  const std::size_t rows = size_[0] * size_[1];
  Steps here{Bits(rows * words_), Bits(rows * words_)};
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t z = 0; z < size_[2]; ++z) {
      const std::uint64_t bit = std::uint64_t{1} << (z % 64);
      (free.is_free(row * size_[2] + z) ? here.free : here.unknown)[row * words_ + z / 64] |= bit;
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
      here.unknown[(x * size_[1] + y) * words_ + z / 64] &= ~(std::uint64_t{1} << (z % 64));
    });
  }
  for (Bits& plane : counts_) plane.assign(rows * words_, 0);
  for (int i = 0; i < 27; ++i) {
    const Direction by{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
    const int squared = by[0] * by[0] + by[1] * by[1] + by[2] * by[2];
    if (squared == 0) continue;
    const auto wanted =
        static_cast<unsigned>(std::max(1.0, reach / std::sqrt(double{1} * squared)));
    const Steps one{moved(here.free, by, 1), moved(here.unknown, by, 1)};
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

// From each cell what is `steps` further on.
OpenDirections::Bits OpenDirections::moved(const Bits& bits, const Direction& by, int steps) const {
  Bits result(bits.size(), 0);
  const auto [nx, ny, nz] =
      std::array{static_cast<int>(size_[0]), static_cast<int>(size_[1]), by[2] * steps};
  const int dx = by[0] * steps, dy = by[1] * steps;
  const auto shift = static_cast<unsigned>(std::abs(nz));
  for (int x = std::max(0, -dx); x < std::min(nx, nx - dx); ++x) {
    for (int y = std::max(0, -dy); y < std::min(ny, ny - dy); ++y) {
      const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * ny + j) * words_; };
      const std::uint64_t* in = &bits[at(x + dx, y + dy)];
      std::uint64_t* out = &result[at(x, y)];
      for (std::size_t w = 0; w < words_; ++w) {
        if (shift == 0) {
          out[w] = in[w];
        } else if (nz > 0) {
          out[w] = in[w] >> shift | (w + 1 < words_ ? in[w + 1] << (64 - shift) : 0);
        } else {
          out[w] = in[w] << shift | (w > 0 ? in[w - 1] >> (64 - shift) : 0);
        }
      }
    }
  }
  return result;
}

OpenDirections::Steps OpenDirections::joined(const Steps& first, const Steps& then,
                                             const Direction& by, int steps) const {
  Steps result{moved(then.free, by, steps), moved(then.unknown, by, steps)};
  for (std::size_t i = 0; i < result.free.size(); ++i) {
    result.free[i] = first.free[i] | (first.unknown[i] & result.free[i]);
    result.unknown[i] &= first.unknown[i];
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
