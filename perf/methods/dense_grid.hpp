// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "oracle/dense_map.hpp"
#include "trace/ray_tile.hpp"
#include "trace_method.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::bench {

/// A workspace as dense arrays for a hierarchical DDA, no tree: a code for each brick of 8³ voxels
/// and each of the eight octants that a ray may go into, and a bit for each voxel. The bricks form
/// a cube whose edge is a power of two; what is added is free. Coordinates are in voxels from the
/// workspace's lowest corner.
struct DenseGrid {
  explicit DenseGrid(const oracle::DenseMap& map);

  int brick_bits = 0;                ///< 2^brick_bits bricks an edge
  std::array<float, 3> low{};        ///< the box round all bricks that are not free
  std::array<float, 3> high{};       ///< equal to low if there are none
  std::array<std::int32_t, 3> dims;  ///< of the map [voxel]

  /// [octant][x][y][z] of the brick; octant bit 2, 1, 0: the ray goes down in x, y, z. Of a free
  /// brick the edge [brick] of the largest free cube that begins there and reaches into the octant;
  /// of another 256 times a byte that says which of its 4³ cubes are not free, bit x << 2 | y << 1
  /// | z. One more at the end, so that pairs can be read.
  std::vector<std::uint16_t> codes;
  /// 16 words a brick [x][y][z]: the voxels that are not free, bit x << 6 | y << 3 | z.
  std::vector<std::uint32_t> masks;
};

/// Where the valid rays of a tile of 4×4 pixels end; those of other lanes are not defined.
using DenseTileTracer = void (*)(const DenseGrid& grid, const detail::TileTable& table,
                                 const detail::PoseFrame& frame, std::size_t tile,
                                 std::span<Ending, detail::kTileRays> endings);

/// The tracer of an instruction set that the CPU supports.
[[nodiscard]] DenseTileTracer dense_tile_tracer(Isa isa);

}  // namespace viewgain::bench
