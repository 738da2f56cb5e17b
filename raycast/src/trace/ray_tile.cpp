// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "ray_tile.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace viewgain::detail {
namespace {

// The solid angle of each pixel [sr]: cos³α |∂(x, y) / ∂(u, v)| for its direction (x, y, 1), α from
// the optical axis; 0 where a pixel has no ray. Differences are central, at the image's edge and
// beside pixels without a ray one-sided.
std::vector<double> solid_angles(const PinholeCamera& camera,
                                 const std::vector<Eigen::Vector3d>& table) {
  const auto ray = [&](int u, int v) -> const Eigen::Vector3d* {
    if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) return nullptr;
    const Eigen::Vector3d& found =
        table[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
              static_cast<std::size_t>(u)];
    return found.allFinite() ? &found : nullptr;
  };
  std::vector<double> angles(table.size());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d* own = ray(u, v);
      if (own == nullptr) continue;
      const auto slope = [&](int du, int dv, const Eigen::Vector2d& ideal) -> Eigen::Vector2d {
        const Eigen::Vector3d* before = ray(u - du, v - dv);
        const Eigen::Vector3d* after = ray(u + du, v + dv);
        const double steps = (before != nullptr ? 1 : 0) + (after != nullptr ? 1 : 0);
        if (steps == 0) return ideal;
        return ((after != nullptr ? *after : *own) - (before != nullptr ? *before : *own))
                   .head<2>() /
               steps;
      };
      const Eigen::Vector2d across = slope(1, 0, {1.0 / camera.fx, 0.0});
      const Eigen::Vector2d down = slope(0, 1, {0.0, 1.0 / camera.fy});
      const double cosine = 1.0 / own->norm();
      angles[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
             static_cast<std::size_t>(u)] =
          cosine * cosine * cosine * std::abs(across.x() * down.y() - across.y() * down.x());
    }
  }
  return angles;
}

}  // namespace

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
  const std::vector<double> angles = solid_angles(camera, table);
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
