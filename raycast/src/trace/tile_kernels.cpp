// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A tile of rays is set up for a pose, and led through a primitive. Compiled once for each
// instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/tile_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include "leaf_walk-inl.hpp"
#include "tile_kernels.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Directions of a tile in the grid's frame and their inverses.
void set_up(const TileTable& table, const PoseFrame& frame, std::size_t tile, RayTile& out) {
  const float* table_x = table.directions.data() + tile * 3 * kTileRays;
  const float* table_y = table_x + kTileRays;
  const float* table_z = table_y + kTileRays;
  const VF tiny = hn::Set(df, 1e-20F);
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    const VF x = hn::LoadU(df, table_x + lane0), y = hn::LoadU(df, table_y + lane0),
             z = hn::LoadU(df, table_z + lane0);
    const auto row = [&](std::size_t r, float* direction, float* inverse) HWY_ATTR {
      const VF d = hn::Add(hn::Add(hn::Mul(hn::Set(df, frame.rotation[3 * r]), x),
                                   hn::Mul(hn::Set(df, frame.rotation[3 * r + 1]), y)),
                           hn::Mul(hn::Set(df, frame.rotation[3 * r + 2]), z));
      // Zero counts as a small positive number: 0 * inverse stays 0, and a ray that runs in a face
      // belongs to the larger index.
      const VF safe = hn::IfThenElse(hn::Lt(hn::Abs(d), tiny), tiny, d);
      hn::Store(safe, df, direction + lane0);
      hn::Store(hn::Div(hn::Set(df, 1.0F), safe), df, inverse + lane0);
    };
    row(0, out.dx, out.ix);
    row(1, out.dy, out.iy);
    row(2, out.dz, out.iz);
    hn::Store(hn::Set(df, frame.max_range), df, out.range + lane0);
    hn::Store(hn::Set(du, kNoPrimitive), du, out.primitive + lane0);
  }
  out.valid = table.valid[tile];
  out.hit = 0;
  out.blocked = 0;
  out.has_far = false;
}

void visit(const SceneData& scene, const PoseFrame& frame, std::uint32_t primitive, RayTile& out) {
  const Slabs slabs = slabs_of(scene.boxes[primitive], frame);
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    VF range = hn::Load(df, out.range + lane0);
    const MF active = mask_of(out.valid >> lane0);
    const auto each = [&](auto kernel) HWY_ATTR {
      return meet(scene, frame, out, lane0, primitive, slabs, active, range, kernel);
    };
    const MF hits =
        primitive < scene.leaf_count
            ? each([](auto&&... a) HWY_ATTR { return walk_leaf(static_cast<decltype(a)>(a)...); })
            : each([](auto&&... a) HWY_ATTR { return enter_box(static_cast<decltype(a)>(a)...); });
    hn::Store(range, df, out.range + lane0);
    out.hit |= bits_of(hits) << lane0;
  }
}

void block(const SceneData& scene, const PoseFrame& frame, std::uint32_t leaf,
           const TraceMask& mask, RayTile& out) {
  const Slabs slabs = slabs_of(scene.boxes[leaf], frame);
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    // An obstacle's number is below all leaves': what begins at min_range is not taken.
    LaneEnds ends{hn::Min(hn::Load(df, out.range + lane0), hn::Set(df, frame.min_range)),
                  hn::Set(du, kObstaclePrimitive), hn::Zero(du)};
    const MF hits = walk_mask(scene, frame, mask, 0, rays_of(out, lane0), leaf, slabs,
                              mask_of(out.valid >> lane0), ends);
    hn::BlendedStore(ends.range, hits, df, out.range + lane0);
    hn::BlendedStore(hn::Set(du, kObstaclePrimitive), hn::RebindMask(du, hits), du,
                     out.primitive + lane0);
    out.blocked |= bits_of(hits) << lane0;
  }
}

}  // namespace

const TileKernels& kernels(Isa isa) {
  static const TileKernels table{isa, kWidth, set_up, visit, block};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

const TileKernels& tile_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, kernels)(isa); }

}  // namespace viewgain::detail
#endif
