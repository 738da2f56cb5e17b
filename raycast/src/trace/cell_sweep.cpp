// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Sweeping the primitives of a cell over the rays that they can end, tile by tile or, where they
// are small in the image, in windows of 4×4 rays. Compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/cell_sweep.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "cell_sweep.hpp"
#include "image_bounds-inl.hpp"
#include "leaf_walk-inl.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Of a region: a primitive a block.
constexpr std::size_t kMostMembers = 64;

constexpr std::uint32_t kPacketLanes = (1U << kWidth) - 1U;

// Cells whose blocks are up to so many rays wide are swept in windows.
constexpr float kSmall = 4;

// Rows of a window that a packet holds, and those of one from a place on.
constexpr int kRows = kWidth / kTileEdge;
template <typename T>
HWY_INLINE auto load_rows(const T* at, std::size_t pitch) {
  constexpr hn::CappedTag<T, 4> d4;
#if HWY_TARGET == HWY_AVX3
  constexpr hn::CappedTag<T, 8> d8;
  constexpr hn::CappedTag<T, 16> d16;
  return hn::Combine(d16,
                     hn::Combine(d8, hn::LoadU(d4, at + 3 * pitch), hn::LoadU(d4, at + 2 * pitch)),
                     hn::Combine(d8, hn::LoadU(d4, at + pitch), hn::LoadU(d4, at)));
#elif HWY_TARGET == HWY_AVX2
  constexpr hn::CappedTag<T, 8> d8;
  return hn::Combine(d8, hn::LoadU(d4, at + pitch), hn::LoadU(d4, at));
#else
  (void)pitch;
  return hn::LoadU(d4, at);
#endif
}

// The rays that a primitive is swept over, and what is known of them: is_first, no ray that is left
// has met anything; is_final, those that end here meet nothing nearer.
struct Sweep {
  const SceneData& scene;
  const PoseFrame& frame;
  StripRays& strip;
  float near;  // no primitive of the cell begins nearer, along the axis
  bool is_first, is_final;
};

template <bool kIsLeaf>
HWY_INLINE MF meet(const Sweep& sweep, std::uint32_t primitive, const Slabs& slabs,
                   const LaneRays& rays, std::uint32_t lanes, LaneEnds& ends) {
  if constexpr (kIsLeaf) {
    return walk_leaf(sweep.scene, sweep.frame, rays, primitive, slabs, mask_of(lanes), ends);
  } else {
    return enter_box(sweep.scene, sweep.frame, rays, primitive, slabs, mask_of(lanes), ends);
  }
}

// In windows of 4×4 rays that begin where the rectangle does: fewer than tiles where it is small.
template <bool kIsLeaf>
HWY_INLINE void sweep_windows(const Sweep& sweep, std::uint32_t primitive, const ImageRect& rect) {
  StripRays& strip = sweep.strip;
  const Slabs slabs = slabs_of(sweep.scene.boxes[primitive], sweep.frame);
  for (std::int32_t row = rect.row0; row <= rect.row1; row += kRows) {
    const int rows = std::min(kRows, rect.row1 - row + 1);
    for (std::int32_t column = rect.column0; column <= rect.column1; column += kTileEdge) {
      std::uint32_t lanes = 0;
      for (int k = 0; k < rows; ++k) lanes |= strip.left().four(row + k, column) << (k * kTileEdge);
      const std::int32_t rest = rect.column1 - column;
      if (rest < kTileEdge - 1) lanes &= ((2U << rest) - 1U) * 0x1111U;
      if (lanes == 0) continue;
      const std::size_t at = strip.place(row, column), pitch = strip.pitch();
      const auto load = [&](const auto* from) HWY_ATTR { return load_rows(from + at, pitch); };
      const LaneRays rays{load(strip.direction(0)), load(strip.direction(1)),
                          load(strip.direction(2)), load(strip.inverse(0)),
                          load(strip.inverse(1)),   load(strip.inverse(2))};
      LaneEnds ends{hn::Set(df, sweep.frame.max_range), hn::Set(du, kNoPrimitive), hn::Zero(du)};
      if (!sweep.is_first) {
        ends.range = load(strip.range());
        ends.primitive = load(strip.primitive());
      }
      std::uint32_t ended = bits_of(meet<kIsLeaf>(sweep, primitive, slabs, rays, lanes, ends));
      if (ended == 0) continue;
      HWY_ALIGN float ranges[kWidth];
      HWY_ALIGN std::uint32_t offsets[kWidth];
      hn::Store(ends.range, df, ranges);
      hn::Store(ends.offset, du, offsets);
      for (; ended != 0; ended &= ended - 1) {
        const int lane = std::countr_zero(ended);
        strip.end(row + (lane >> 2), column + (lane & 3), ranges[lane], primitive, offsets[lane],
                  sweep.is_final);
      }
    }
  }
}

// Tile by tile: less to do for each.
template <bool kIsLeaf>
HWY_INLINE void sweep_tiles(const Sweep& sweep, std::uint32_t primitive, const ImageRect& rect) {
  const Slabs slabs = slabs_of(sweep.scene.boxes[primitive], sweep.frame);
  for (const auto& [number, lanes_found] : sweep.strip.left_in(rect)) {
    RayTile& tile = sweep.strip.meet(number, sweep.near);
    // Some may have ended as the tile was made.
    const std::uint32_t lanes = lanes_found & sweep.strip.left().of_tile(number);
    std::uint32_t ended = 0;
    for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
      const std::uint32_t part = lanes >> lane0 & kPacketLanes;
      if (kWidth < kTileRays && part == 0) continue;
      LaneEnds ends{hn::Set(df, sweep.frame.max_range), hn::Set(du, kNoPrimitive), hn::Zero(du)};
      if (!sweep.is_first) {
        ends.range = hn::Load(df, tile.range + lane0);
        ends.primitive = hn::Load(du, tile.primitive + lane0);
      }
      const MF hits = meet<kIsLeaf>(sweep, primitive, slabs, rays_of(tile, lane0), part, ends);
      if (hn::AllFalse(df, hits)) continue;
      ended |= bits_of(hits) << lane0;
      const auto hits_u = hn::RebindMask(du, hits);
      hn::BlendedStore(ends.range, hits, df, tile.range + lane0);
      hn::BlendedStore(ends.primitive, hits_u, du, tile.primitive + lane0);
      hn::BlendedStore(ends.offset, hits_u, du, tile.offset + lane0);
    }
    sweep.strip.end_in_tile(number, ended, sweep.is_final);
  }
}

void sweep(const SceneData& scene, const SeenCell& seen_cell, const PoseFrame& frame,
           const ImageScale& image, const std::array<std::int32_t, 3>& camera_block,
           StripRays& strip) {
  ImageRect cell_rect = seen_cell.rect;
  if (!strip.clip(cell_rect) || !strip.left().any_in_tiles(cell_rect)) return;
  const std::uint32_t cell = seen_cell.cell;
  const SceneCells& cells = *scene.cells;
  const CellPlace& place = cells.places[cell];
  // How far each row of blocks of the region is from the camera's.
  std::array<std::array<std::uint8_t, 4>, 3> distance;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t low = place.node[k] * 16 + place.part[k] * 4;
    for (std::int32_t i = 0; i < 4; ++i) {
      distance[k][static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(distance_in_four(low, i, camera_block[k]));
    }
  }
  // Are its blocks, of eight voxels, small in the image?
  const bool by_rows = 8 * image.scale_x <= kSmall * seen_cell.near;
  if (by_rows) strip.meet_by_rows(cell_rect, seen_cell.near);
  struct Found {
    std::uint32_t primitive;
    ImageRect rect;
  };
  Found found[kMostMembers];
  std::uint8_t keys[kMostMembers], order[kMostMembers];
  std::uint8_t begins[kDistances + 1] = {};
  std::size_t count = 0;
  ImageBounds bounds;
  for (std::size_t at = cells.first[cell]; at < cells.first[cell + 1]; at += kBoxVector) {
    bounds_of(cells.members, at, frame, image, bounds);
    for (std::uint32_t seen = bounds.seen; seen != 0; seen &= seen - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(seen));
      const std::uint32_t primitive = cells.primitives[at + i];
      ImageRect rect = bounds.rect(i);
      if (primitive == kNoPrimitive || !strip.clip(rect)) continue;
      const RaysLeft& left = strip.left();
      if (!(by_rows ? left.any_in_rows(rect) : left.any_in_tiles(rect))) continue;
      __builtin_prefetch(&scene.boxes[primitive]);
      if (primitive < scene.leaf_count) __builtin_prefetch(&scene.masks[primitive]);
      const std::uint8_t block = cells.blocks[at + i];
      const auto key = static_cast<std::uint8_t>(
          distance[0][block & 3U] + distance[1][block >> 2U & 3U] + distance[2][block >> 4U & 3U]);
      found[count] = {primitive, rect};
      keys[count++] = key;
      ++begins[key + 1U];
    }
  }
  for (std::size_t k = 0; k < kDistances; ++k) {
    begins[k + 1] = static_cast<std::uint8_t>(begins[k + 1] + begins[k]);
  }
  for (std::size_t i = 0; i < count; ++i) order[begins[keys[i]]++] = static_cast<std::uint8_t>(i);
  const Sweep to{
      scene,           frame, strip, seen_cell.near, !scene.has_obstacles && !cells.has_larger,
      !place.is_larger};
  for (std::size_t i = 0; i < count; ++i) {
    const Found& next = found[order[i]];
    if (next.primitive < scene.leaf_count) {
      by_rows ? sweep_windows<true>(to, next.primitive, next.rect)
              : sweep_tiles<true>(to, next.primitive, next.rect);
    } else {
      by_rows ? sweep_windows<false>(to, next.primitive, next.rect)
              : sweep_tiles<false>(to, next.primitive, next.rect);
    }
  }
}

}  // namespace

CellSweep cell_sweep_of_target() { return sweep; }

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

CellSweep cell_sweep(Isa isa) { return VIEWGAIN_OF_ISA(isa, cell_sweep_of_target)(); }

}  // namespace viewgain::detail
#endif
