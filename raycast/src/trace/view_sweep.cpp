// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "view_sweep.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace viewgain::detail {
namespace {

// Rounding moves a distance by less.
float safely_near(float near) { return near - 1e-5F * std::abs(near); }

// Which of sixteen boxes come within `reach` of the camera.
std::uint32_t within_reach(const BoxArrays& boxes, std::size_t first, const PoseFrame& frame,
                           float reach) {
  const auto beyond = [](float center, float half, float at) {
    return std::max(std::abs(center - at) - half, 0.0F);
  };
  std::array<float, kBoxVector> squared;
  for (std::size_t i = 0; i < kBoxVector; ++i) {
    const std::size_t at = first + i;
    const float x = beyond(boxes.center_x[at], boxes.half_x[at], frame.origin[0]),
                y = beyond(boxes.center_y[at], boxes.half_y[at], frame.origin[1]),
                z = beyond(boxes.center_z[at], boxes.half_z[at], frame.origin[2]);
    squared[i] = x * x + y * y + z * z;
  }
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < kBoxVector; ++i) {
    near |= (squared[i] <= reach * reach ? 1U : 0U) << i;
  }
  return near;
}

// The occupied voxels of a leaf, without that of the camera.
TraceMask blocking_mask(const SceneData& scene, std::uint32_t primitive, const PoseFrame& frame) {
  const GridSnapshot::Leaf& leaf = scene.snapshot.leaves[scene.leaf_source[primitive]];
  const Index3& base = scene.snapshot.min_index;
  TraceMask mask;
  for (std::size_t i = 0; i < leaf.occupied.size(); ++i) {
    mask.words[2 * i] = static_cast<std::uint32_t>(leaf.occupied[i]);
    mask.words[2 * i + 1] = static_cast<std::uint32_t>(leaf.occupied[i] >> 32U);
  }
  const auto place = [&](std::size_t axis, std::int32_t lowest, std::int32_t leaf_lowest) {
    return static_cast<std::int32_t>(std::floor(frame.origin[axis])) + lowest - leaf_lowest;
  };
  const std::int32_t x = place(0, base.x, leaf.origin.x), y = place(1, base.y, leaf.origin.y),
                     z = place(2, base.z, leaf.origin.z);
  if (std::min({x, y, z}) >= 0 && std::max({x, y, z}) < 8) {
    const auto offset = static_cast<std::uint32_t>(x << 6 | y << 3 | z);
    mask.words[offset >> 5U] &= ~(1U << (offset & 31U));
  }
  return mask;
}

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

void NearSurface::find(const ImageBoundsKernels& kernels, const SceneData& scene,
                       const PoseFrame& frame, const ImageScale& image, const TileTable& table) {
  parts_.clear();
  tile_columns_ = table.tile_columns();
  if (!(frame.min_range > 0)) return;
  const SceneCells& cells = *scene.cells;
  const float reach = 1.001F * frame.min_range + 0.1F + frame.extra_margin;
  ImageBounds bounds;
  for (std::size_t first = 0; first < cells.count(); first += kBoxVector) {
    std::uint32_t near_cells = within_reach(cells.boxes, first, frame, reach);
    if (cells.count() - first < kBoxVector) near_cells &= (1U << (cells.count() - first)) - 1U;
    for (; near_cells != 0; near_cells &= near_cells - 1) {
      const std::size_t cell = first + static_cast<std::size_t>(std::countr_zero(near_cells));
      for (std::size_t at = cells.first[cell]; at < cells.first[cell + 1]; at += kBoxVector) {
        std::uint32_t near = within_reach(cells.members, at, frame, reach);
        for (std::uint32_t left = near; left != 0; left &= left - 1) {
          const auto i = static_cast<std::size_t>(std::countr_zero(left));
          const std::uint32_t primitive = cells.primitives[at + i];
          if (primitive >= scene.leaf_count || scene.has_occupied[primitive] == 0) {
            near &= ~(1U << i);
          }
        }
        if (near == 0) continue;
        kernels.bounds_of(cells.members, at, frame, image, bounds);
        for (near &= bounds.seen; near != 0; near &= near - 1) {
          const auto i = static_cast<std::size_t>(std::countr_zero(near));
          const std::uint32_t primitive = cells.primitives[at + i];
          const auto tile = [](std::int32_t ray) {
            return static_cast<std::uint32_t>(ray) / kTileEdge;
          };
          const ImageRect rect = bounds.rect(i);
          parts_.push_back({primitive, tile(rect.column0), tile(rect.column1), tile(rect.row0),
                            tile(rect.row1), blocking_mask(scene, primitive, frame)});
        }
      }
    }
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
