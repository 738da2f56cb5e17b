// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "ray_tile.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace viewgain::detail {

TileTable::TileTable(const PinholeCamera& camera, int pixel_stride)
    : columns(strided(camera.width, pixel_stride)), rows(strided(camera.height, pixel_stride)) {
  const int tile_columns = (columns + kTileEdge - 1) / kTileEdge;
  const int tile_rows = (rows + kTileEdge - 1) / kTileEdge;
  tile_count = static_cast<std::size_t>(tile_columns) * static_cast<std::size_t>(tile_rows);
  directions.resize(tile_count * 3 * kTileRays);
  valid.resize(tile_count);
  solid_angle.resize(tile_count * kTileRays);
  cosine.resize(tile_count);
  first_lane.resize(tile_count);

  const std::vector<Eigen::Vector3d> table = camera.ray_table();
  const std::vector<double> angles = camera.solid_angles(table);
  const double pixels = static_cast<double>(pixel_stride) * pixel_stride;  // that a ray stands for
  for (std::size_t tile = 0; tile < tile_count; ++tile) {
    const int column0 = static_cast<int>(tile % static_cast<std::size_t>(tile_columns)) * kTileEdge;
    const int row0 = static_cast<int>(tile / static_cast<std::size_t>(tile_columns)) * kTileEdge;
    first_lane[tile] = static_cast<std::uint32_t>(row0 * columns + column0);
    unsigned lanes = 0;
    for (int lane = 0; lane < kTileRays; ++lane) {
      const int column = column0 + lane % kTileEdge;
      const int row = row0 + lane / kTileEdge;
      const int u = std::min(column, columns - 1) * pixel_stride;
      const int v = std::min(row, rows - 1) * pixel_stride;
      const std::size_t pixel =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
          static_cast<std::size_t>(u);
      const Eigen::Vector3d direction = table[pixel].normalized();
      solid_angle[tile * kTileRays + static_cast<std::size_t>(lane)] =
          static_cast<float>(pixels * angles[pixel]);
      // A pixel that the distortion model cannot invert has no ray.
      const bool usable = column < columns && row < rows && direction.allFinite();
      if (usable) lanes |= 1U << lane;
      for (int axis = 0; axis < 3; ++axis) {
        directions[tile * 3 * kTileRays + static_cast<std::size_t>(axis * kTileRays + lane)] =
            direction.allFinite() ? static_cast<float>(direction[axis]) : (axis == 2 ? 1.0F : 0.0F);
      }
    }
    valid[tile] = static_cast<std::uint16_t>(lanes);
    const float* z = directions.data() + tile * 3 * kTileRays + 2 * kTileRays;
    cosine[tile] = *std::max_element(z, z + kTileRays);
  }
}

}  // namespace viewgain::detail
