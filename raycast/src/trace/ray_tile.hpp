// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/walk_task.hpp"

namespace viewgain::detail {

/// Of so many pixels every stride-th, the first included.
[[nodiscard]] inline int strided(int pixels, int stride) { return (pixels - 1) / stride + 1; }

/// What a ray has met at an obstacle, or at known surface before min_range; below every primitive's
/// number as a signed one, so that an obstacle wins a tie with a voxel.
inline constexpr std::uint32_t kObstaclePrimitive = 0xFFFFFFFFU;

/// Every step-th ray of every step-th row, from that column and row on.
struct RayLattice {
  int step = 1;
  int column = 0, row = 0;
};

/// Unit directions of a sensor's (strided) pixels in the camera frame, tile by tile: 16 x, 16 y, 16
/// z. Lanes beyond the image's edge repeat a ray and are not valid.
struct TileTable {
  int columns = 0;  ///< rays a row
  int rows = 0;
  std::size_t tile_count = 0;
  std::vector<float> directions;     ///< 48 a tile
  std::vector<std::uint16_t> valid;  ///< one bit a lane
  /// 16 a tile: what each ray stands for [sr], its pixel's times pixels over rays of the image; of
  /// a lattice step² times that, which the estimate corrects (SampledViews).
  std::vector<float> solid_angle;
  std::vector<float> cosine;              ///< the largest of a tile's rays with the optical axis
  std::vector<std::uint32_t> first_lane;  ///< ray index (row by row) of lane 0 of each tile

  TileTable(const PinholeCamera& camera, int pixel_stride);
  /// Some of the rays of another table, in tiles of their own.
  TileTable(const TileTable& full, const RayLattice& lattice);

  [[nodiscard]] std::size_t tile_columns() const {
    return static_cast<std::size_t>((columns + kTileEdge - 1) / kTileEdge);
  }
  [[nodiscard]] std::size_t tile_rows() const {
    return static_cast<std::size_t>((rows + kTileEdge - 1) / kTileEdge);
  }
  [[nodiscard]] std::size_t ray_count() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  /// Ray index of a valid lane.
  [[nodiscard]] std::size_t ray_index(std::size_t tile, int lane) const {
    return first_lane[tile] +
           static_cast<std::size_t>(lane / kTileEdge) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(lane % kTileEdge);
  }
  /// The same among all rays of the image, where these are some of them.
  [[nodiscard]] std::size_t image_ray_index(std::size_t tile, int lane) const {
    const auto own = static_cast<std::size_t>(columns), step = static_cast<std::size_t>(part_.step);
    const std::size_t index = ray_index(tile, lane);
    return (static_cast<std::size_t>(part_.row) + index / own * step) *
               static_cast<std::size_t>(image_columns_) +
           static_cast<std::size_t>(part_.column) + index % own * step;
  }

 private:
  struct Ray {
    bool is_valid;
    float solid_angle;
    std::array<float, 3> direction;
  };
  template <typename RayAt>
  void fill(const RayAt& ray_at);

  RayLattice part_{};
  int image_columns_ = 0;
};

/// Cameras farther than this from the workspace's lowest corner [voxels] see nothing: single
/// precision hardly tells one voxel from the next there.
inline constexpr double kFarthestCamera = 1e6;

/// A camera pose as the tracer sees it. Lengths are in voxels, coordinates relative to the lowest
/// corner of the workspace, so that single precision serves the workspace and not its distance from
/// an origin.
struct PoseFrame {
  std::array<float, 3> origin{};    ///< camera centre
  std::array<float, 9> rotation{};  ///< R_grid_camera, row by row
  float min_range = 0;
  float max_range = 0;
  float extra_margin = 0;     ///< by which boxes in lists count as larger, against rounding
  bool sees_nothing = false;  ///< too far away: not to be traced
};

/// One tile of rays and where they end.
struct alignas(64) RayTile {
  float dx[kTileRays], dy[kTileRays], dz[kTileRays];  ///< unit directions, grid frame
  float ix[kTileRays], iy[kTileRays], iz[kTileRays];  ///< 1 / direction; zero counts as 1e-20
  float range[kTileRays];                             ///< where the ray ends [voxels]
  std::uint32_t primitive[kTileRays];                 ///< leaf or box, kNoPrimitive: no voxel
  std::uint32_t offset[kTileRays];  ///< voxel in the primitive, see scene_data.hpp
  float far[kTileRays];             ///< where it meets an obstacle [voxels], if that was asked for
  std::uint32_t valid = 0;          ///< one bit a lane
  std::uint32_t hit = 0;            ///< lanes that end in a voxel
  std::uint32_t blocked = 0;  ///< lanes that end at an obstacle or, before min_range, at surface
  bool has_far = false;       ///< is `far` known? Else no obstacle ends a ray beyond a voxel
};

}  // namespace viewgain::detail
