// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "dense_grid.hpp"

#include <algorithm>
#include <bit>
#include <span>

namespace viewgain::bench {
namespace {

constexpr std::uint16_t kFarthestSkip = 127;  // [brick]
constexpr std::size_t kWordsPerMask = 16;

// Sets the bits of a brick's voxels that are not free and returns the code of such a brick; 0 if
// all are free.
std::uint16_t fill_mask(const oracle::DenseMap& map, int bx, int by, int bz,
                        std::span<std::uint32_t, kWordsPerMask> words) {
  const auto count = [](int b, int dims) { return std::clamp(dims - 8 * b, 0, 8); };
  const int nx = count(bx, map.dims.x), ny = count(by, map.dims.y), nz = count(bz, map.dims.z);
  unsigned cubes = 0;
  for (int x = 0; x < nx; ++x) {
    for (int y = 0; y < ny; ++y) {
      for (int z = 0; z < nz; ++z) {
        const Index3 voxel{map.min_index.x + 8 * bx + x, map.min_index.y + 8 * by + y,
                           map.min_index.z + 8 * bz + z};
        if (map.states[map.position(voxel)] == static_cast<std::uint8_t>(VoxelState::free)) {
          continue;
        }
        const auto bit = static_cast<unsigned>(x << 6 | y << 3 | z);
        words[bit >> 5U] |= 1U << (bit & 31U);
        cubes |= 1U << static_cast<unsigned>(x >> 2 << 2 | y >> 2 << 1 | z >> 2);
      }
    }
  }
  return static_cast<std::uint16_t>(cubes << 8U);
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
  masks.assign(kWordsPerMask * count, 0);
  std::vector<std::uint16_t> solid(count);  // codes of bricks that are not free
  std::array<int, 3> first{edge, edge, edge};
  std::array<int, 3> last{-1, -1, -1};
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) {
        const std::size_t i = index(x, y, z);
        const std::span<std::uint32_t, kWordsPerMask> words(&masks[kWordsPerMask * i],
                                                            kWordsPerMask);
        solid[i] = fill_mask(map, x, y, z, words);
        if (solid[i] == 0) continue;
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
  codes.resize(8 * count + 1);
  for (int octant = 0; octant < 8; ++octant) {
    std::uint16_t* out = &codes[static_cast<std::size_t>(octant) * count];
    const int flip_x = (octant & 4) != 0 ? edge - 1 : 0, flip_y = (octant & 2) != 0 ? edge - 1 : 0,
              flip_z = (octant & 1) != 0 ? edge - 1 : 0;
    const auto at = [&](int x, int y, int z) { return index(x ^ flip_x, y ^ flip_y, z ^ flip_z); };
    const auto skip = [&](int x, int y, int z) -> std::uint16_t {
      if (x == edge || y == edge || z == edge) return kFarthestSkip;
      return out[at(x, y, z)] & 255;  // 0: not free
    };
    for (int x = edge - 1; x >= 0; --x) {
      for (int y = edge - 1; y >= 0; --y) {
        for (int z = edge - 1; z >= 0; --z) {
          const std::uint16_t least = std::min(
              {skip(x + 1, y, z), skip(x, y + 1, z), skip(x, y, z + 1), skip(x + 1, y + 1, z),
               skip(x + 1, y, z + 1), skip(x, y + 1, z + 1), skip(x + 1, y + 1, z + 1)});
          const std::size_t i = at(x, y, z);
          const int free = std::min(least + 1, int{kFarthestSkip});
          out[i] = solid[i] != 0 ? solid[i] : static_cast<std::uint16_t>(free);
        }
      }
    }
  }
}

}  // namespace viewgain::bench
