// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image_bounds.hpp"
#include "ray_tile.hpp"
#include "viewgain/core/camera.hpp"

namespace viewgain::detail {

/// Where in a sensor's image boxes lie, whatever the scene. Immutable.
class ImageProjector {
 public:
  ImageProjector(const PinholeCamera& camera, int pixel_stride, const TileTable& table);

  /// For rays that count from min_range [voxels] on.
  [[nodiscard]] ImageScale scale_for(const PoseFrame& frame, float min_range) const;

 private:
  LensBend lens_;
  float scale_x_ = 0, shift_x_ = 0;  // ray column = scale * x / z + shift, the lens apart
  float scale_y_ = 0, shift_y_ = 0;
  float last_column_ = 0, last_row_ = 0;
  float least_cosine_ = 1;  // of a ray with the optical axis
  float widest_slope_ = 0;  // of a ray to the optical axis, or more
};

}  // namespace viewgain::detail
