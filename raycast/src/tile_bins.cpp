// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tile_bins.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "scene_data.hpp"
#include "tile_bins.hpp"

#ifndef VIEWGAIN_TILE_BINS_ONCE
#define VIEWGAIN_TILE_BINS_ONCE
namespace viewgain::detail {

constexpr std::size_t kBoxVector = 16;

// Where sixteen boxes lie in the image, in rays; empty if max < min.
struct ImageBounds {
  alignas(64) float min_column[kBoxVector], max_column[kBoxVector];
  alignas(64) float min_row[kBoxVector], max_row[kBoxVector];
  alignas(64) float distance[kBoxVector];  // twice the centre's, along the optical axis [voxels]
  bool at_camera = false;                  // some box reaches the camera's plane: no bounds
};

struct ImageScale {
  float scale_x, shift_x, scale_y, shift_y;
};

}  // namespace viewgain::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Rounding moves a bound by less than this many rays.
constexpr float kRayMargin = 0.05F;

ImageBounds bounds_of(const SceneBoxes& boxes, std::size_t first, const PoseFrame& frame,
                      const ImageScale& image) {
  constexpr hn::CappedTag<float, kBoxVector> df;
  using VF = hn::Vec<decltype(df)>;
  ImageBounds out;
  const auto& R = frame.rotation;
  const VF zero = hn::Zero(df), nearest = hn::Set(df, 1e-3F);
  for (std::size_t i = 0; i < kBoxVector; i += hn::Lanes(df)) {
    const std::size_t at = first + i;
    const VF dx = hn::Sub(hn::LoadU(df, &boxes.center_x[at]), hn::Set(df, frame.origin[0]));
    const VF dy = hn::Sub(hn::LoadU(df, &boxes.center_y[at]), hn::Set(df, frame.origin[1]));
    const VF dz = hn::Sub(hn::LoadU(df, &boxes.center_z[at]), hn::Set(df, frame.origin[2]));
    const VF hx = hn::LoadU(df, &boxes.half_x[at]), hy = hn::LoadU(df, &boxes.half_y[at]),
             hz = hn::LoadU(df, &boxes.half_z[at]);
    // The box in the camera's axes: centre and reach along each.
    const auto along = [&](std::size_t axis, VF& low, VF& high) HWY_ATTR {
      const VF a = hn::Set(df, R[axis]), b = hn::Set(df, R[3 + axis]), c = hn::Set(df, R[6 + axis]);
      const VF center = hn::Add(hn::Mul(a, dx), hn::Add(hn::Mul(b, dy), hn::Mul(c, dz)));
      const VF reach = hn::Add(hn::Mul(hn::Abs(a), hx),
                               hn::Add(hn::Mul(hn::Abs(b), hy), hn::Mul(hn::Abs(c), hz)));
      low = hn::Sub(center, reach);
      high = hn::Add(center, reach);
    };
    VF x_low, x_high, y_low, y_high, z_low, z_high;
    along(0, x_low, x_high);
    along(1, y_low, y_high);
    along(2, z_low, z_high);
    hn::Store(hn::Add(z_low, z_high), df, out.distance + i);
    const auto behind = hn::Lt(z_high, zero);
    if (!hn::AllFalse(df, hn::AndNot(behind, hn::Lt(z_low, nearest)))) out.at_camera = true;
    const VF one = hn::Set(df, 1.0F);
    const VF by_near = hn::Div(one, hn::Max(z_low, nearest));
    const VF by_far = hn::Div(one, hn::Max(z_high, nearest));
    const VF margin = hn::Set(df, kRayMargin), nowhere = hn::Set(df, -1e9F);
    const auto project = [&](VF low, VF high, float scale, float shift, float* min_out,
                             float* max_out) HWY_ATTR {
      const VF least = hn::Mul(low, hn::IfThenElse(hn::Lt(low, zero), by_near, by_far));
      const VF most = hn::Mul(high, hn::IfThenElse(hn::Lt(high, zero), by_far, by_near));
      const VF s = hn::Set(df, scale), o = hn::Set(df, shift);
      hn::Store(hn::Sub(hn::Add(hn::Mul(least, s), o), margin), df, min_out + i);
      hn::Store(hn::IfThenElse(behind, nowhere, hn::Add(hn::Add(hn::Mul(most, s), o), margin)), df,
                max_out + i);
    };
    project(x_low, x_high, image.scale_x, image.shift_x, out.min_column, out.max_column);
    project(y_low, y_high, image.scale_y, image.shift_y, out.min_row, out.max_row);
  }
  return out;
}

}  // namespace

using BoundsOf = ImageBounds (*)(const SceneBoxes&, std::size_t, const PoseFrame&,
                                 const ImageScale&);
BoundsOf bounds_kernel() { return bounds_of; }

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {
namespace {

// Boxes count as larger by this much [voxels], against rounding.
constexpr float kBoxMargin = 0.02F;

auto kernel_of(Isa isa) {
  switch (isa) {
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::bounds_kernel();
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::bounds_kernel();
#endif
    default:
      return HWY_STATIC_DISPATCH(bounds_kernel)();
  }
}

// One box for all primitives whose centre lies in the same cell of this edge [voxels].
std::vector<PrimitiveBox> merged(const std::vector<PrimitiveBox>& boxes, float edge) {
  std::map<std::array<int, 3>, PrimitiveBox> cells;
  for (const PrimitiveBox& box : boxes) {
    std::array<int, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      cell[k] = static_cast<int>(std::floor((box.min[k] + box.max[k]) / (2.0F * edge)));
    }
    const auto [entry, is_new] = cells.try_emplace(cell, box);
    if (is_new) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      entry->second.min[k] = std::min(entry->second.min[k], box.min[k]);
      entry->second.max[k] = std::max(entry->second.max[k], box.max[k]);
    }
  }
  std::vector<PrimitiveBox> out;
  for (const auto& [cell, box] : cells) out.push_back(box);
  return out;
}

// Rays whose number lies in [min, max], as tiles; false if there are none.
bool tile_range(float min, float max, float last, std::uint16_t& first_tile,
                std::uint16_t& last_tile) {
  const float low = std::max(min, 0.0F), high = std::min(max, last);
  if (!(low <= high)) return false;
  first_tile = static_cast<std::uint16_t>(static_cast<int>(low) / kTileEdge);
  last_tile = static_cast<std::uint16_t>(static_cast<int>(high) / kTileEdge);
  return true;
}

// Distances along the optical axis in 256 steps: enough to put near boxes first.
constexpr std::size_t kDistanceSteps = 256;

}  // namespace

SceneBoxes::SceneBoxes(const std::vector<PrimitiveBox>& primitives)
    : are_primitives(primitives.size() <= kMaxBoxes) {
  std::vector<PrimitiveBox> coarse;
  const std::vector<PrimitiveBox>* boxes = &primitives;
  for (float edge = 16.0F; boxes->size() > kMaxBoxes; edge *= 2.0F) {
    coarse = merged(*boxes, edge);
    boxes = &coarse;
  }
  const auto append = [this](const PrimitiveBox& box) {
    const auto center = [&](std::size_t k) { return 0.5F * (box.min[k] + box.max[k]); };
    const auto half = [&](std::size_t k) { return 0.5F * (box.max[k] - box.min[k]) + kBoxMargin; };
    center_x.push_back(center(0)), center_y.push_back(center(1)), center_z.push_back(center(2));
    half_x.push_back(half(0)), half_y.push_back(half(1)), half_z.push_back(half(2));
  };
  count = boxes->size();
  for (const PrimitiveBox& box : *boxes) append(box);
  while (center_x.size() % kBoxVector != 0) append(boxes->back());
}

TileBinner::TileBinner(const PinholeCamera& camera, int pixel_stride, const TileTable& table)
    : usable_(!camera.has_distortion()),
      scale_x_(static_cast<float>(camera.fx / pixel_stride)),
      shift_x_(static_cast<float>(camera.cx / pixel_stride)),
      scale_y_(static_cast<float>(camera.fy / pixel_stride)),
      shift_y_(static_cast<float>(camera.cy / pixel_stride)),
      last_column_(static_cast<float>(table.columns - 1)),
      last_row_(static_cast<float>(table.rows - 1)),
      tile_columns_(static_cast<std::size_t>((table.columns + kTileEdge - 1) / kTileEdge)),
      tile_count_(table.tile_count) {}

void TileBinner::sort(Isa isa, const SceneBoxes& boxes, const PoseFrame& frame,
                      TileBins& bins) const {
  bins.valid_ = false;
  if (!usable_) return;
  const auto bounds_of = kernel_of(isa);
  const ImageScale image{scale_x_, shift_x_, scale_y_, shift_y_};

  // Where each box lies in the image and how far off it is.
  bins.entries_.clear();
  bins.starts_.assign(tile_count_ + 1, 0);
  float nearest = std::numeric_limits<float>::max(), farthest = 0;
  for (std::size_t first = 0; first < boxes.count; first += kBoxVector) {
    const ImageBounds bounds = bounds_of(boxes, first, frame, image);
    if (bounds.at_camera) return;
    const std::size_t count = std::min(kBoxVector, boxes.count - first);
    for (std::size_t i = 0; i < count; ++i) {
      TileBins::Entry entry{};
      if (!tile_range(bounds.min_column[i], bounds.max_column[i], last_column_, entry.column0,
                      entry.column1) ||
          !tile_range(bounds.min_row[i], bounds.max_row[i], last_row_, entry.row0, entry.row1)) {
        continue;
      }
      entry.box = static_cast<std::uint32_t>(first + i);
      entry.distance = bounds.distance[i];
      nearest = std::min(nearest, entry.distance);
      farthest = std::max(farthest, entry.distance);
      bins.entries_.push_back(entry);
    }
  }

  // Near boxes first: a counting sort.
  std::array<std::uint32_t, kDistanceSteps + 1> begins{};
  const float scale = static_cast<float>(kDistanceSteps - 1) / std::max(farthest - nearest, 1e-6F);
  const auto step_of = [&](const TileBins::Entry& entry) {
    return static_cast<std::size_t>((entry.distance - nearest) * scale);
  };
  for (const TileBins::Entry& entry : bins.entries_) ++begins[step_of(entry) + 1];
  for (std::size_t i = 0; i < kDistanceSteps; ++i) begins[i + 1] += begins[i];
  bins.sorted_.resize(bins.entries_.size());
  for (const TileBins::Entry& entry : bins.entries_) bins.sorted_[begins[step_of(entry)]++] = entry;

  // Each tile's boxes side by side: count, then fill.
  const auto for_each_tile = [&](const TileBins::Entry& entry, auto&& visit) {
    for (std::size_t row = entry.row0; row <= entry.row1; ++row) {
      for (std::size_t column = entry.column0; column <= entry.column1; ++column) {
        visit(row * tile_columns_ + column);
      }
    }
  };
  std::uint32_t* const starts = bins.starts_.data();
  for (const TileBins::Entry& entry : bins.sorted_) {
    for_each_tile(entry, [&](std::size_t tile) { ++starts[tile]; });
  }
  std::uint32_t total = 0;
  for (std::size_t tile = 0; tile < tile_count_; ++tile) {
    total += starts[tile];
    starts[tile] = total;
  }
  starts[tile_count_] = total;
  bins.boxes_.resize(total);
  std::uint32_t* const out = bins.boxes_.data();
  // Backwards, so that each start moves down to where its tile begins.
  for (auto entry = bins.sorted_.rbegin(); entry != bins.sorted_.rend(); ++entry) {
    for_each_tile(*entry, [&](std::size_t tile) { out[--starts[tile]] = entry->box; });
  }
  bins.valid_ = true;
}

}  // namespace viewgain::detail
#endif
