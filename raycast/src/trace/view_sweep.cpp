// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_sweep.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "scene/scene_data.hpp"

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

void ViewSweep::see(const ImageBoundsKernels& kernels, const SceneCells& cells,
                    const PoseFrame& frame, const ImageScale& image) {
  // The camera's place on the lattices; beyond the scene only its side matters.
  std::array<std::int32_t, 3> node{}, part{};
  std::uint32_t farthest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t voxel =
        cells.base[k] + static_cast<std::int32_t>(std::floor(frame.origin[k]));
    camera_block[k] = voxel >> 3;
    node[k] = voxel >> 7;
    part[k] = voxel >> 5;
    const std::int32_t at = std::clamp(node[k], cells.min_node[k], cells.max_node[k]);
    farthest +=
        static_cast<std::uint32_t>(std::max(at - cells.min_node[k], cells.max_node[k] - at));
    node[k] = at;
  }
  found_.clear();
  keys_.clear();
  ImageBounds bounds;
  for (std::size_t first = 0; first < cells.count(); first += kBoxVector) {
    kernels.bounds_of(cells.boxes, first, frame, image, bounds);
    std::uint32_t bits = bounds.seen;
    if (cells.count() - first < kBoxVector) bits &= (1U << (cells.count() - first)) - 1U;
    for (; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(bits));
      const CellPlace& place = cells.places[first + i];
      std::uint32_t key = 0;
      if (!place.is_larger) {
        std::int32_t nodes = 0, parts = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          nodes += std::abs(place.node[k] - node[k]);
          parts += distance_in_four(place.node[k] * 4, place.part[k], part[k]);
        }
        key =
            1 + static_cast<std::uint32_t>(nodes) * kDistances + static_cast<std::uint32_t>(parts);
      }
      found_.push_back({static_cast<std::uint32_t>(first + i), bounds.near[i], bounds.rect(i)});
      keys_.push_back(key);
    }
  }
  // In order of their keys.
  begins_.assign(2 + (farthest + 1) * kDistances, 0);
  for (const std::uint32_t key : keys_) ++begins_[key + 1];
  for (std::size_t i = 0; i + 1 < begins_.size(); ++i) begins_[i + 1] += begins_[i];
  seen.resize(found_.size());
  for (std::size_t i = 0; i < found_.size(); ++i) seen[begins_[keys_[i]]++] = found_[i];
}

}  // namespace viewgain::detail
