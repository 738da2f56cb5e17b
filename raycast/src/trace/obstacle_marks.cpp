// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "obstacle_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace viewgain::detail {
namespace {

// Rounding moves a distance by less.
float safely_near(float near) { return near - 1e-5F * std::abs(near); }

// How far along the axis any point of a box from the origin is, or a little more.
float farthest_along_axis(const std::array<float, 3>& size, const PoseFrame& frame) {
  float sum = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const float along = frame.rotation[3 * a + 2];
    sum += std::max(along * (size[a] - frame.origin[a]), -along * frame.origin[a]);
  }
  return sum + 1.0F + 1e-5F * std::abs(sum);
}

}  // namespace

void ObstacleMarks::mark(const ImageBoundsKernels& kernels, const ObstacleScene& obstacles,
                         const PoseFrame& frame, const ImageScale& image, const TileTable& table,
                         bool only_before_voxels) {
  near_.assign(table.tile_count, kNoObstacle);
  farthest_voxel_ = farthest_along_axis(obstacles.workspace(), frame);
  const float limit =
      only_before_voxels ? std::min(frame.max_range, farthest_voxel_) : frame.max_range;
  const std::size_t tile_columns = table.tile_columns();
  // Calls visit(i) for those of `count` boxes that are in the image and before the limit.
  const auto for_each_seen = [&](const BoxArrays& boxes, std::size_t first, std::size_t count,
                                 ImageBounds& bounds, const auto& visit) {
    kernels.bounds_of(boxes, first, frame, image, bounds);
    for (std::size_t i = 0; i < count; ++i) {
      if ((bounds.seen >> i & 1U) != 0 && safely_near(bounds.near[i]) <= limit) visit(i);
    }
  };
  const std::size_t count = obstacles.piece_count();
  const std::size_t groups = (count + kBoxVector - 1) / kBoxVector;
  ImageBounds of_groups, bounds;
  for (std::size_t first = 0; first < groups; first += kBoxVector) {
    for_each_seen(
        obstacles.groups(), first, std::min(kBoxVector, groups - first), of_groups,
        [&](std::size_t g) {
          const std::size_t at = (first + g) * kBoxVector;
          for_each_seen(
              obstacles.pieces(), at, std::min(kBoxVector, count - at), bounds, [&](std::size_t i) {
                const ImageRect rect = bounds.rect(i);
                for (std::int32_t row = rect.row0 / kTileEdge; row <= rect.row1 / kTileEdge;
                     ++row) {
                  float* const tiles = near_.data() + static_cast<std::size_t>(row) * tile_columns;
                  for (std::int32_t c = rect.column0 / kTileEdge; c <= rect.column1 / kTileEdge;
                       ++c) {
                    tiles[c] = std::min(tiles[c], safely_near(bounds.near[i]));
                  }
                }
              });
        });
  }
}

}  // namespace viewgain::detail
