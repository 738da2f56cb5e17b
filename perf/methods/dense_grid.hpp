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

/// A workspace as dense arrays for a hierarchical DDA, without a tree. There is a code for each
/// brick of 8³ voxels and each octant of ray directions, and a bit for each voxel. The bricks form
/// a cube with a power of two per edge; added bricks are free. Coordinates are in voxels from the
/// lowest corner of the workspace.
struct DenseGrid {
  explicit DenseGrid(const oracle::DenseMap& map);

  int brick_bits = 0;                ///< 2^brick_bits bricks per edge
  std::array<float, 3> low{};        ///< of the box around all bricks that are not free
  std::array<float, 3> high{};       ///< equal to low if there are none
  std::array<std::int32_t, 3> dims;  ///< of the map [voxel]

  /// By [octant][x][y][z] of the brick. Bits 2, 1, 0 of the octant are set if the ray goes down in
  /// x, y, z.
  /// - free brick: the edge [brick] of the largest free cube that begins there and extends into the
  ///   octant
  /// - other brick: 256 times a byte with bit x << 2 | y << 1 | z for each 4³ cube that is not free
  ///
  /// There is one more element at the end, so that pairs can be read.
  std::vector<std::uint16_t> codes;
  /// 16 words per brick [x][y][z], with bit x << 6 | y << 3 | z for each voxel that is not free.
  std::vector<std::uint32_t> masks;
};

/// Finds where the valid rays of a tile of 4×4 pixels end. Other lanes are undefined.
using DenseTileTracer = void (*)(const DenseGrid& grid, const detail::TileTable& table,
                                 const detail::PoseFrame& frame, std::size_t tile,
                                 std::span<Ending, detail::kTileRays> endings);

/// The tracer of an instruction set that the CPU supports.
[[nodiscard]] DenseTileTracer dense_tile_tracer(Isa isa);

}  // namespace viewgain::bench
