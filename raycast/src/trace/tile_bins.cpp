// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "tile_bins.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "obstacle_scene.hpp"
#include "scene/scene_data.hpp"

namespace viewgain::detail {
namespace {

// Below this a camera's plane is too near to divide by [voxels].
constexpr float kLeastDepth = 1e-3F;

// Tiles of the rays whose numbers, whole ones, lie in [min, max]; false if there are none.
template <typename Integer>
bool tile_range(float min, float max, float last, Integer& first_tile, Integer& last_tile) {
  const float low = std::ceil(std::max(min, 0.0F)), high = std::floor(std::min(max, last));
  if (!(low <= high)) return false;
  first_tile = static_cast<Integer>(static_cast<int>(low) / kTileEdge);
  last_tile = static_cast<Integer>(static_cast<int>(high) / kTileEdge);
  return true;
}

// The tiles that box i of sixteen covers; false if none.
template <typename Integer>
bool outline(const ImageBounds& bounds, std::size_t i, const ImageScale& image, Integer& column0,
             Integer& column1, Integer& row0, Integer& row1) {
  return tile_range(bounds.min_column[i], bounds.max_column[i], image.last_column, column0,
                    column1) &&
         tile_range(bounds.min_row[i], bounds.max_row[i], image.last_row, row0, row1);
}

// Appends those of so many boxes that are in the image.
template <typename Entry, typename Name>
void append_seen(const ImageBounds& bounds, const ImageScale& image, std::size_t count,
                 std::vector<Entry>& out, const Name& name) {
  for (std::size_t i = 0; i < count; ++i) {
    Entry entry{};
    if (!outline(bounds, i, image, entry.column0, entry.column1, entry.row0, entry.row1)) continue;
    entry.box = name(i);
    entry.near = bounds.near[i];
    out.push_back(entry);
  }
}

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

// Puts entries in order of distance along the optical axis, in steps: a counting sort. They count
// as being as near as their step begins, less the rounding, so that no later one is nearer.
template <std::size_t kSteps, typename Entry>
void sort_by_distance(const std::vector<Entry>& entries, std::vector<Entry>& sorted) {
  sorted.resize(entries.size());
  if (entries.empty()) return;
  float nearest = entries.front().near, farthest = nearest;
  for (const Entry& entry : entries) {
    nearest = std::min(nearest, entry.near);
    farthest = std::max(farthest, entry.near);
  }
  std::array<std::uint32_t, kSteps + 1> begins{};
  const float step = std::max(farthest - nearest, 1e-6F) / static_cast<float>(kSteps - 1);
  const auto step_of = [&](const Entry& entry) {
    return std::min(static_cast<std::size_t>((entry.near - nearest) / step), kSteps - 1);
  };
  for (const Entry& entry : entries) ++begins[step_of(entry) + 1];
  for (std::size_t i = 0; i < kSteps; ++i) begins[i + 1] += begins[i];
  for (const Entry& entry : entries) {
    const std::size_t at = step_of(entry);
    Entry& out = sorted[begins[at]++];
    out = entry;
    out.near = safely_near(nearest + static_cast<float>(at) * step);
  }
}

// Of a view's boxes, and of a cell's.
constexpr std::size_t kViewSteps = 256, kCellSteps = 32;

}  // namespace

TileBinner::TileBinner(const PinholeCamera& camera, int pixel_stride, const TileTable& table)
    : lens_(camera, table),
      scale_x_(static_cast<float>(camera.fx / pixel_stride)),
      shift_x_(static_cast<float>(camera.cx / pixel_stride)),
      scale_y_(static_cast<float>(camera.fy / pixel_stride)),
      shift_y_(static_cast<float>(camera.cy / pixel_stride)),
      last_column_(static_cast<float>(table.columns - 1)),
      last_row_(static_cast<float>(table.rows - 1)),
      tile_columns_(static_cast<std::size_t>((table.columns + kTileEdge - 1) / kTileEdge)),
      tile_count_(table.tile_count) {
  for (std::size_t tile = 0; tile < table.tile_count; ++tile) {
    const float* z = table.directions.data() + tile * 3 * kTileRays + 2 * kTileRays;
    least_cosine_ = std::min(least_cosine_, *std::min_element(z, z + kTileRays));
  }
  widest_slope_ = lens_.is_bent
                      ? std::max(-lens_.low_x, lens_.high_x) + std::max(-lens_.low_y, lens_.high_y)
                      : std::max({shift_x_, last_column_ - shift_x_, 1.0F}) / scale_x_ +
                            std::max({shift_y_, last_row_ - shift_y_, 1.0F}) / scale_y_;
}

ImageScale TileBinner::image_of(const PoseFrame& frame, float min_range) const {
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

void TileBinner::mark_obstacles(Isa isa, const ObstacleScene& obstacles, const PoseFrame& frame,
                                bool only_before_voxels, TileBins& bins) const {
  const ImageBoundsKernels& kernels = image_bounds_kernels(isa);
  const ImageScale image = image_of(frame, 0);
  bins.obstacle_near_.assign(tile_count_, TileBins::kNoObstacle);
  bins.farthest_voxel_ = farthest_along_axis(obstacles.workspace(), frame);
  const float limit =
      only_before_voxels ? std::min(frame.max_range, bins.farthest_voxel_) : frame.max_range;
  const auto mark = [&](const ImageBounds& bounds, std::size_t i) {
    std::size_t column0 = 0, column1 = 0, row0 = 0, row1 = 0;
    const float near = safely_near(bounds.near[i]);
    if (near > limit || !outline(bounds, i, image, column0, column1, row0, row1)) return;
    for (std::size_t row = row0; row <= row1; ++row) {
      float* const tiles = bins.obstacle_near_.data() + row * tile_columns_;
      for (std::size_t c = column0; c <= column1; ++c) tiles[c] = std::min(tiles[c], near);
    }
  };
  const std::size_t count = obstacles.piece_count();
  const std::size_t groups = (count + kBoxVector - 1) / kBoxVector;
  for (std::size_t first = 0; first < groups; first += kBoxVector) {
    const ImageBounds of_groups = kernels.bounds_of(obstacles.groups(), first, frame, image);
    for (std::size_t g = 0; g < std::min(kBoxVector, groups - first); ++g) {
      std::size_t column0 = 0, column1 = 0, row0 = 0, row1 = 0;
      if (safely_near(of_groups.near[g]) > limit ||
          !outline(of_groups, g, image, column0, column1, row0, row1)) {
        continue;
      }
      const std::size_t at = (first + g) * kBoxVector;
      const ImageBounds bounds = kernels.bounds_of(obstacles.pieces(), at, frame, image);
      for (std::size_t i = 0; i < std::min(kBoxVector, count - at); ++i) mark(bounds, i);
    }
  }
}

void TileBinner::sort(Isa isa, const SceneBoxes& scene, const PoseFrame& frame,
                      TileBins& bins) const {
  bins.valid_ = false;
  const ImageBoundsKernels& kernels = image_bounds_kernels(isa);
  const ImageScale image = image_of(frame, frame.min_range);

  // Where each box lies in the image and how far off it is; near ones first.
  bins.entries_.clear();
  bins.starts_.resize(tile_count_ + 1);
  for (std::size_t first = 0; first < scene.count; first += kBoxVector) {
    const ImageBounds bounds = kernels.bounds_of(scene.boxes, first, frame, image);
    append_seen(bounds, image, std::min(kBoxVector, scene.count - first), bins.entries_,
                [&](std::size_t i) { return static_cast<std::uint32_t>(first + i); });
  }
  sort_by_distance<kViewSteps>(bins.entries_, bins.sorted_);

  // Each tile's boxes side by side: count, then fill.
  const auto for_each_tile = [&](const TileBins::Entry& entry, auto&& visit) {
    for (std::size_t row = entry.row0; row <= entry.row1; ++row) {
      for (std::size_t column = entry.column0; column <= entry.column1; ++column) {
        visit(row * tile_columns_ + column);
      }
    }
  };
  // Counting by differences: a rectangle adds one where it begins and takes it back where it ends.
  const std::size_t tile_rows = tile_count_ / tile_columns_, pitch = tile_columns_ + 1;
  bins.differences_.assign((tile_rows + 1) * pitch, 0);
  std::int32_t* const differences = bins.differences_.data();
  for (const TileBins::Entry& entry : bins.sorted_) {
    ++differences[entry.row0 * pitch + entry.column0];
    --differences[entry.row0 * pitch + entry.column1 + 1U];
    --differences[(entry.row1 + 1U) * pitch + entry.column0];
    ++differences[(entry.row1 + 1U) * pitch + entry.column1 + 1U];
  }
  std::uint32_t* const starts = bins.starts_.data();
  std::uint32_t total = 0;
  for (std::size_t row = 0; row < tile_rows; ++row) {
    std::int32_t* const here = differences + row * pitch;
    std::int32_t along = 0;
    for (std::size_t column = 0; column < tile_columns_; ++column) {
      along += here[column];
      const std::int32_t above =
          row > 0 ? here[static_cast<std::ptrdiff_t>(column) - static_cast<std::ptrdiff_t>(pitch)]
                  : 0;
      here[column] = above + along;  // now the number of boxes over this tile
      total += static_cast<std::uint32_t>(here[column]);
      starts[row * tile_columns_ + column] = total;
    }
  }
  starts[tile_count_] = total;
  bins.boxes_.resize(total);
  TileBox* const out = bins.boxes_.data();
  // Backwards, so that each start moves down to where its tile begins.
  for (auto entry = bins.sorted_.rbegin(); entry != bins.sorted_.rend(); ++entry) {
    for_each_tile(*entry, [&](std::size_t tile) {
      out[--starts[tile]] = {entry->box, entry->near};
    });
  }

  if (!scene.are_primitives()) {
    if (bins.cells_.size() < scene.count) bins.cells_.resize(scene.count);
    if (++bins.generation_ == 0) {  // after 2^32 views old stamps would look new
      std::fill(bins.cells_.begin(), bins.cells_.end(), TileBins::Cell{});
      bins.generation_ = 1;
    }
    bins.member_.clear();
    bins.column0_.clear(), bins.column1_.clear(), bins.row0_.clear(), bins.row1_.clear();
  }
  bins.valid_ = true;
}

void TileBinner::project_cell(const ImageBoundsKernels& kernels, const SceneBoxes& scene,
                              const PoseFrame& frame, std::uint32_t cell, TileBins& bins) const {
  const ImageScale image = image_of(frame, frame.min_range);
  bins.entries_.clear();
  for (std::size_t at = scene.first[cell]; at < scene.first[cell + 1]; at += kBoxVector) {
    const ImageBounds bounds = kernels.bounds_of(scene.members, at, frame, image);
    std::size_t count = kBoxVector;
    while (scene.primitives[at + count - 1] == kNoPrimitive) --count;
    append_seen(bounds, image, count, bins.entries_,
                [&](std::size_t i) { return scene.primitives[at + i]; });
  }
  sort_by_distance<kCellSteps>(bins.entries_, bins.sorted_);

  TileBins::Cell& state = bins.cells_[cell];
  state.generation = bins.generation_;
  state.begin = static_cast<std::uint32_t>(bins.member_.size());
  const auto append = [&](const TileBins::Entry& entry) {
    bins.column0_.push_back(static_cast<std::int16_t>(entry.column0));
    bins.column1_.push_back(static_cast<std::int16_t>(entry.column1));
    bins.row0_.push_back(static_cast<std::int16_t>(entry.row0));
    bins.row1_.push_back(static_cast<std::int16_t>(entry.row1));
    bins.member_.push_back({entry.box, entry.near});
  };
  for (const TileBins::Entry& entry : bins.sorted_) append(entry);
  // Columns 1 to 0: covers no tile.
  while (bins.member_.size() % kBoxVector != 0) append({kNoPrimitive, 0, 1, 0, 1, 0});
  state.end = static_cast<std::uint32_t>(bins.member_.size());
}

std::span<const TileBox> TileBinner::select(Isa isa, const SceneBoxes& scene,
                                            const PoseFrame& frame, std::uint32_t cell,
                                            std::size_t tile, float of_interest,
                                            TileBins& bins) const {
  const ImageBoundsKernels& kernels = image_bounds_kernels(isa);
  const TileBins::Cell& state = bins.cells_[cell];
  if (state.generation != bins.generation_) project_cell(kernels, scene, frame, cell, bins);
  bins.selected_.clear();
  const auto column = static_cast<std::int16_t>(tile % tile_columns_);
  const auto row = static_cast<std::int16_t>(tile / tile_columns_);
  for (std::size_t at = state.begin; at < state.end && bins.member_[at].near <= of_interest;
       at += kBoxVector) {
    std::uint32_t bits = kernels.covering(&bins.column0_[at], &bins.column1_[at], &bins.row0_[at],
                                          &bins.row1_[at], column, row);
    for (; bits != 0; bits &= bits - 1) {
      bins.selected_.push_back(bins.member_[at + static_cast<std::size_t>(std::countr_zero(bits))]);
    }
  }
  return bins.selected_;
}

}  // namespace viewgain::detail
