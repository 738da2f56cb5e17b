// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "ray_tile.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "viewgain/support/shared_rays.hpp"

namespace viewgain::detail {

// Columns and rows are known; ray_at(column, row) is asked once for each lane.
template <typename RayAt>
void TileTable::fill(const RayAt& ray_at) {
  tile_count = tile_columns() * tile_rows();
  directions.resize(tile_count * 3 * kTileRays);
  valid.resize(tile_count);
  solid_angle.resize(tile_count * kTileRays);
  cosine.resize(tile_count);
  first_lane.resize(tile_count);
  for (std::size_t tile = 0; tile < tile_count; ++tile) {
    const int column0 = static_cast<int>(tile % tile_columns()) * kTileEdge;
    const int row0 = static_cast<int>(tile / tile_columns()) * kTileEdge;
    first_lane[tile] = static_cast<std::uint32_t>(row0 * columns + column0);
    unsigned lanes = 0;
    for (int lane = 0; lane < kTileRays; ++lane) {
      const int column = column0 + lane % kTileEdge;
      const int row = row0 + lane / kTileEdge;
      const Ray ray = ray_at(std::min(column, columns - 1), std::min(row, rows - 1));
      solid_angle[tile * kTileRays + static_cast<std::size_t>(lane)] = ray.solid_angle;
      if (column < columns && row < rows && ray.is_valid) lanes |= 1U << lane;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        directions[tile * 3 * kTileRays + axis * kTileRays + static_cast<std::size_t>(lane)] =
            ray.direction[axis];
      }
    }
    valid[tile] = static_cast<std::uint16_t>(lanes);
    const float* z = directions.data() + tile * 3 * kTileRays + 2 * kTileRays;
    cosine[tile] = *std::max_element(z, z + kTileRays);
  }
}

TileTable::TileTable(const PinholeCamera& camera, int pixel_stride)
    : columns(strided(camera.width, pixel_stride)), rows(strided(camera.height, pixel_stride)) {
  image_columns_ = columns;
  const auto shared = shared_rays(camera);
  const std::vector<Eigen::Vector3d>& table = *shared;
  const std::vector<double> angles = camera.solid_angles(table);
  const double pixels = static_cast<double>(table.size()) / static_cast<double>(ray_count());
  fill([&](int column, int row) -> Ray {
    const std::size_t pixel =
        static_cast<std::size_t>(row * pixel_stride) * static_cast<std::size_t>(camera.width) +
        static_cast<std::size_t>(column * pixel_stride);
    const auto angle = static_cast<float>(pixels * angles[pixel]);
    const Eigen::Vector3d direction = table[pixel].normalized();
    // A pixel that the distortion model cannot invert has no ray.
    if (!direction.allFinite()) return {false, angle, {0, 0, 1}};
    return {true,
            angle,
            {static_cast<float>(direction.x()), static_cast<float>(direction.y()),
             static_cast<float>(direction.z())}};
  });
}

TileTable::TileTable(const TileTable& full, const RayLattice& lattice)
    : columns(strided(full.columns - lattice.column, lattice.step)),
      rows(strided(full.rows - lattice.row, lattice.step)),
      part_(lattice),
      image_columns_(full.columns) {
  const auto tile_columns = static_cast<int>(full.tile_columns());
  const auto pixels = static_cast<float>(lattice.step * lattice.step);
  fill([&](int column, int row) -> Ray {
    const int u = lattice.column + column * lattice.step, v = lattice.row + row * lattice.step;
    const auto tile = static_cast<std::size_t>(v / kTileEdge * tile_columns + u / kTileEdge);
    const auto lane = static_cast<std::size_t>(v % kTileEdge * kTileEdge + u % kTileEdge);
    const float* direction = full.directions.data() + tile * 3 * kTileRays + lane;
    return {(full.valid[tile] >> lane & 1U) != 0,
            pixels * full.solid_angle[tile * kTileRays + lane],
            {direction[0], direction[kTileRays], direction[2 * kTileRays]}};
  });
}

}  // namespace viewgain::detail
