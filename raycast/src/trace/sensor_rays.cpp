// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "sensor_rays.hpp"

#include <algorithm>

namespace viewgain::detail {
namespace {

// Below this a camera's plane is too near to divide by [voxels].
constexpr float kLeastDepth = 1e-3F;

}  // namespace

ImageProjector::ImageProjector(const PinholeCamera& camera, int pixel_stride,
                               const TileTable& table)
    : lens_(camera, table),
      scale_x_(static_cast<float>(camera.fx / pixel_stride)),
      shift_x_(static_cast<float>(camera.cx / pixel_stride)),
      scale_y_(static_cast<float>(camera.fy / pixel_stride)),
      shift_y_(static_cast<float>(camera.cy / pixel_stride)),
      last_column_(static_cast<float>(table.columns - 1)),
      last_row_(static_cast<float>(table.rows - 1)) {
  for (std::size_t tile = 0; tile < table.tile_count; ++tile) {
    const float* z = table.directions.data() + tile * 3 * kTileRays + 2 * kTileRays;
    least_cosine_ = std::min(least_cosine_, *std::min_element(z, z + kTileRays));
  }
  widest_slope_ = lens_.is_bent
                      ? std::max(-lens_.low_x, lens_.high_x) + std::max(-lens_.low_y, lens_.high_y)
                      : std::max({shift_x_, last_column_ - shift_x_, 1.0F}) / scale_x_ +
                            std::max({shift_y_, last_row_ - shift_y_, 1.0F}) / scale_y_;
}

ImageScale ImageProjector::scale_for(const PoseFrame& frame, float min_range) const {
  // A ray that has gone min_range is at least this far along the axis.
  const float nearest = 0.999F * min_range * least_cosine_;
  const float touching = nearest < kLeastDepth ? 1.01F * kLeastDepth * widest_slope_ : -kEverywhere;
  return {.scale_x = scale_x_,
          .shift_x = shift_x_,
          .scale_y = scale_y_,
          .shift_y = shift_y_,
          .nearest = std::max(nearest, kLeastDepth),
          .touching = touching,
          .last_column = last_column_,
          .last_row = last_row_,
          .margin = frame.extra_margin,
          .lens = lens_};
}

}  // namespace viewgain::detail
