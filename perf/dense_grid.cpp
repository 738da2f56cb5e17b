// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "dense_grid.hpp"

#include <algorithm>
#include <bit>

namespace viewgain::bench {
namespace {

constexpr std::uint32_t kFarthestSkip = 127;  // [brick]
constexpr std::size_t kWordsPerMask = 16;

using Words = std::array<std::uint32_t, kWordsPerMask>;

// The voxels of a brick that are not free.
Words mask_of(const oracle::DenseMap& map, int bx, int by, int bz) {
  Words words{};
  const auto count = [](int b, int dims) { return std::clamp(dims - 8 * b, 0, 8); };
  const int nx = count(bx, map.dims.x), ny = count(by, map.dims.y), nz = count(bz, map.dims.z);
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      for (int z = 0; z < nz; ++z) {
        const auto row = static_cast<std::size_t>((8 * bx + x) * map.dims.y + 8 * by + y);
        const std::size_t voxel =
            row * static_cast<std::size_t>(map.dims.z) + static_cast<std::size_t>(8 * bz + z);
        if (map.states[voxel] == static_cast<std::uint8_t>(VoxelState::free)) continue;
        const auto bit = static_cast<unsigned>(x << 6 | y << 3 | z);
        words[bit >> 5U] |= 1U << (bit & 31U);
      }
    }
  }
  return words;
}

}  // namespace

DenseGrid::DenseGrid(const oracle::DenseMap& map) : dims{map.dims.x, map.dims.y, map.dims.z} {
  const auto bricks = [](int n) { return static_cast<unsigned>((n + 7) / 8); };
  const unsigned most = std::max({bricks(map.dims.x), bricks(map.dims.y), bricks(map.dims.z)});
  brick_bits = std::bit_width(std::bit_ceil(most)) - 1;
  const int edge = 1 << brick_bits;
  const auto index = [&](int x, int y, int z) {
    return static_cast<std::size_t>((x << brick_bits | y) << brick_bits | z);
  };
  const std::size_t count = std::size_t{1} << 3 * brick_bits;
  std::vector<std::uint32_t> numbers(count, 0);  // of the masks; 0: free
  masks.assign(kWordsPerMask, 0);
  masks.insert(masks.end(), kWordsPerMask, 0xFFFFFFFFU);
  std::array<int, 3> first{edge, edge, edge};
  std::array<int, 3> last{-1, -1, -1};
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) {
        const Words words = mask_of(map, x, y, z);
        const auto is = [&](std::uint32_t word) {
          return std::all_of(words.begin(), words.end(), [&](auto w) { return w == word; });
        };
        if (is(0)) continue;
        if (is(0xFFFFFFFFU)) {
          numbers[index(x, y, z)] = 1;
        } else {
          numbers[index(x, y, z)] = static_cast<std::uint32_t>(masks.size() / kWordsPerMask);
          masks.insert(masks.end(), words.begin(), words.end());
        }
        const std::array<int, 3> brick{x, y, z};
        for (std::size_t k = 0; k < 3; ++k) {
          first[k] = std::min(first[k], brick[k]);
          last[k] = std::max(last[k], brick[k]);
        }
      }
    }
  }
  if (last[0] >= 0) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = static_cast<float>(8 * first[k]);
      high[k] = static_cast<float>(std::min(8 * last[k] + 8, dims[k]));
    }
  }

  // From the far corner of each octant back: a cube is one longer than the least of the seven that
  // begin at its neighbours farther on.
  codes.resize(8 * count);
  for (int octant = 0; octant < 8; ++octant) {
    std::uint32_t* out = &codes[static_cast<std::size_t>(octant) * count];
    const int flip_x = (octant & 4) != 0 ? edge - 1 : 0, flip_y = (octant & 2) != 0 ? edge - 1 : 0,
              flip_z = (octant & 1) != 0 ? edge - 1 : 0;
    const auto at = [&](int x, int y, int z) { return index(x ^ flip_x, y ^ flip_y, z ^ flip_z); };
    const auto skip = [&](int x, int y, int z) {
      if (x == edge || y == edge || z == edge) return kFarthestSkip;
      return numbers[at(x, y, z)] != 0 ? 0 : out[at(x, y, z)];
    };
    for (int x = edge - 1; x >= 0; --x) {
      for (int y = edge - 1; y >= 0; --y) {
        for (int z = edge - 1; z >= 0; --z) {
          const std::uint32_t number = numbers[at(x, y, z)];
          const std::uint32_t least = std::min(
              {skip(x + 1, y, z), skip(x, y + 1, z), skip(x, y, z + 1), skip(x + 1, y + 1, z),
               skip(x + 1, y, z + 1), skip(x, y + 1, z + 1), skip(x + 1, y + 1, z + 1)});
          out[at(x, y, z)] = number != 0 ? number << 8U : std::min(least + 1, kFarthestSkip);
        }
      }
    }
  }
}

}  // namespace viewgain::bench
