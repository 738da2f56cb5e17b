// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "ray_tile.hpp"
#include "scene/scene_cells.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// Beyond every column and row, and farther than any point.
inline constexpr float kEverywhere = 1e9F;

/// Rays of the image, the last ones included.
struct ImageRect {
  std::int32_t column0, column1, row0, row1;
};

/// Which rays sixteen boxes can meet.
struct ImageBounds {
  alignas(64) std::int32_t column0[kBoxVector], column1[kBoxVector];
  alignas(64) std::int32_t row0[kBoxVector], row1[kBoxVector];
  alignas(64) float near[kBoxVector];  ///< where it begins along the optical axis [voxels]
  std::uint32_t seen = 0;              ///< one bit a box: is there any ray?

  [[nodiscard]] ImageRect rect(std::size_t i) const {
    return {column0[i], column1[i], row0[i], row1[i]};
  }
};

/// A lens, which bends the outlines of boxes. Slopes are x / z and y / z of undistorted rays.
struct LensBend {
  bool is_bent = false;
  float k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;        ///< OpenCV's
  float low_x = 0, high_x = 0, low_y = 0, high_y = 0;  ///< all rays have slopes between these
  /// The most that second derivatives of distorted slopes are there: of the column along x and
  /// along y, of the row along x and along y.
  float column_xx = 0, column_yy = 0, row_xx = 0, row_yy = 0;

  LensBend() = default;
  /// For the rays of a table.
  LensBend(const PinholeCamera& camera, const TileTable& table);
};

/// From a box in the camera's axes to its image.
struct ImageScale {
  float scale_x, shift_x, scale_y, shift_y;  ///< ray column = scale * distorted slope + shift
  float nearest;   ///< along the optical axis [voxels]; what is nearer no ray meets
  float touching;  ///< except in boxes that come so close to the axis [voxels]; negative: none
  float last_column, last_row;
  float margin;  ///< by which boxes count as larger [voxels]
  LensBend lens;
};

/// Kernels of one instruction set.
struct ImageBoundsKernels {
  /// Of boxes first to first + 15. Conservative: each ray that meets a box at or beyond the least
  /// range is within its bounds. With a lens, the outline of a box (a rectangle of slopes) is that
  /// of its corners and what linear interpolation between them can be wrong by at most.
  void (*bounds_of)(const BoxArrays&, std::size_t first, const PoseFrame&, const ImageScale&,
                    ImageBounds& out);
};

/// Kernels of an instruction set that the CPU supports.
[[nodiscard]] const ImageBoundsKernels& image_bounds_kernels(Isa isa);

}  // namespace viewgain::detail
