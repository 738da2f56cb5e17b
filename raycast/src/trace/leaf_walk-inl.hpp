// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Tracing a packet of rays through the 512-bit masks of 8³ leaves, compiled once for each
// instruction set. Only + - × / min max and comparisons are used, so each set takes the same steps
// bit for bit.
//
// All plane distances are (plane - origin) * inverse with the plane an exact integer. Whoever asks
// for the same plane gets the same number, so leaves that share a face agree on which side of it a
// ray is at any t, and no ray slips between them.

// Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_LEAF_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_LEAF_WALK_INL_HPP
#undef VIEWGAIN_LEAF_WALK_INL_HPP
#else
#define VIEWGAIN_LEAF_WALK_INL_HPP
#endif

#include <hwy/highway.h>

#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/support/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// A primitive's box [lo, hi) relative to the origin of the rays.
struct Slabs {
  VF lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
};
HWY_INLINE Slabs slabs_of(const PrimitiveBox& box, const PoseFrame& frame) {
  const auto set = [&](const float* corner, std::size_t axis)
                       HWY_ATTR { return hn::Set(df, corner[axis] - frame.origin[axis]); };
  return {set(box.min, 0), set(box.min, 1), set(box.min, 2),
          set(box.max, 0), set(box.max, 1), set(box.max, 2)};
}

// Entry and exit of a box along the rays.
struct Interval {
  VF enter, exit;
};
HWY_INLINE Interval intersect_slabs(VF ix, VF iy, VF iz, const Slabs& box, float min_range) {
  const VF x0 = hn::Mul(box.lo_x, ix), x1 = hn::Mul(box.hi_x, ix);
  const VF y0 = hn::Mul(box.lo_y, iy), y1 = hn::Mul(box.hi_y, iy);
  const VF z0 = hn::Mul(box.lo_z, iz), z1 = hn::Mul(box.hi_z, iz);
  const VF enter = hn::Max(hn::Max(hn::Set(df, min_range), hn::Min(x0, x1)),
                           hn::Max(hn::Min(y0, y1), hn::Min(z0, z1)));
  const VF exit = hn::Min(hn::Max(x0, x1), hn::Min(hn::Max(y0, y1), hn::Max(z0, z1)));
  return {enter, exit};
}

// Rays of a packet: unit directions and their inverses.
struct LaneRays {
  VF dx, dy, dz, ix, iy, iz;
};
HWY_INLINE LaneRays rays_of(const RayTile& tile, int lane0) {
  const auto load = [&](const float* from) HWY_ATTR { return hn::Load(df, from + lane0); };
  return {load(tile.dx), load(tile.dy), load(tile.dz), load(tile.ix), load(tile.iy), load(tile.iz)};
}

// Where they end so far.
struct LaneEnds {
  VF range;
  VU primitive, offset;
};

// Which lanes may take a hit at `enter` from `primitive`: nearer than what they have, or as near
// and of a lower number, so that the order in which the BVH is walked does not show.
HWY_INLINE MF is_nearer(VF enter, VF range, VU held, std::uint32_t primitive) {
  const MF lower = hn::RebindMask(
      df, hn::Lt(hn::Set(di, static_cast<std::int32_t>(primitive)), hn::BitCast(di, held)));
  return hn::Or(hn::Lt(enter, range), hn::And(hn::Eq(enter, range), lower));
}

HWY_INLINE void take(MF hits, VF range, std::uint32_t primitive, VU offset, LaneEnds& ends) {
  const auto hits_u = hn::RebindMask(du, hits);
  ends.range = hn::IfThenElse(hits, range, ends.range);
  ends.primitive = hn::IfThenElse(hits_u, hn::Set(du, primitive), ends.primitive);
  ends.offset = hn::IfThenElse(hits_u, offset, ends.offset);
}

// Is the bit of a voxel's offset set? Lanes that are done may have left the leaf: any answer will
// do for them, but the lookup must not leave the mask.
HWY_INLINE MF is_solid(const TraceMask& mask, VU offset) {
  const VU word = hn::ShiftRight<5>(offset);
#if HWY_TARGET == HWY_AVX3
  // Permutations and rotations take their counts modulo 16 and 32.
  const VU words{_mm512_permutexvar_epi32(word.raw, hn::Load(du, mask.words.data()).raw)};
  const VU bit{_mm512_rolv_epi32(_mm512_set1_epi32(1), offset.raw)};
  return hn::RebindMask(df, hn::TestBit(words, bit));
#else
  const VU bit = hn::Shl(hn::Set(du, 1U), hn::And(offset, hn::Set(du, 31U)));
#if HWY_TARGET == HWY_AVX2
  // Two lookups in registers take less than a third of the time of a gather.
  const auto in_half = hn::IndicesFromVec(du, hn::And(word, hn::Set(du, 7U)));
  const VU low = hn::TableLookupLanes(hn::Load(du, mask.words.data()), in_half);
  const VU high = hn::TableLookupLanes(hn::Load(du, mask.words.data() + 8), in_half);
  const VU words = hn::IfThenElse(hn::TestBit(word, hn::Set(du, 8U)), high, low);
#else
  const VU words =
      hn::GatherIndex(du, mask.words.data(), hn::BitCast(di, hn::And(word, hn::Set(du, 15U))));
#endif
  return hn::RebindMask(df, hn::TestBit(words, bit));
#endif
}

// Walks the voxels of a leaf along the active rays, from `least_range` on, and notes the first one
// whose bit is set in `mask`, if it is nearer than what the ray has. Returns the lanes that took a
// hit, whose ends are updated.
HWY_INLINE MF walk_mask(const SceneData& scene, const PoseFrame& frame, const TraceMask& mask,
                        float least_range, const LaneRays& rays, std::uint32_t leaf,
                        const Slabs& slabs, MF active, LaneEnds& ends) {
  const VF ix = rays.ix, iy = rays.iy, iz = rays.iz;
  const Interval slab = intersect_slabs(ix, iy, iz, slabs, least_range);
  active = hn::And(active, hn::And(hn::Lt(slab.enter, slab.exit), hn::Le(slab.enter, ends.range)));
  if (hn::AllFalse(df, active)) return active;

  const PrimitiveBox& box = scene.boxes[leaf];
  // The voxel at the entry point; rounding may name a neighbour, whose visit then has no length.
  const VF zero = hn::Zero(df), one = hn::Set(df, 1.0F);
  VF t = slab.enter;
  const auto cell = [&](VF direction, VF lo, std::size_t axis) HWY_ATTR {
    const VF p = hn::Sub(hn::Mul(direction, t), lo);
    const VF last = hn::Set(df, (box.max[axis] - box.min[axis]) - 1.0F);
    return hn::ConvertTo(di, hn::Min(hn::Max(p, zero), last));
  };
  const auto cx = cell(rays.dx, slabs.lo_x, 0), cy = cell(rays.dy, slabs.lo_y, 1),
             cz = cell(rays.dz, slabs.lo_z, 2);
  VU offset =
      hn::Add(hn::Set(du, box.first_offset),
              hn::BitCast(du, hn::Or(hn::ShiftLeft<6>(cx), hn::Or(hn::ShiftLeft<3>(cy), cz))));

  // The plane by which each axis is left next, and what stepping over it changes.
  const VF minus_one = hn::Set(df, -1.0F);
  const MF backward_x = hn::Lt(ix, zero), backward_y = hn::Lt(iy, zero),
           backward_z = hn::Lt(iz, zero);
  const VF step_x = hn::IfThenElse(backward_x, minus_one, one);
  const VF step_y = hn::IfThenElse(backward_y, minus_one, one);
  const VF step_z = hn::IfThenElse(backward_z, minus_one, one);
  const VU offset_x = hn::BitCast(
      du, hn::IfThenElse(hn::RebindMask(di, backward_x), hn::Set(di, -64), hn::Set(di, 64)));
  const VU offset_y = hn::BitCast(
      du, hn::IfThenElse(hn::RebindMask(di, backward_y), hn::Set(di, -8), hn::Set(di, 8)));
  const VU offset_z = hn::BitCast(
      du, hn::IfThenElse(hn::RebindMask(di, backward_z), hn::Set(di, -1), hn::Set(di, 1)));
  const VF ox = hn::Set(df, frame.origin[0]), oy = hn::Set(df, frame.origin[1]),
           oz = hn::Set(df, frame.origin[2]);
  const auto first_plane = [&](auto c, VF step, float low) HWY_ATTR {
    return hn::Add(hn::Add(hn::Set(df, low), hn::ConvertTo(df, c)), hn::Max(step, zero));
  };
  VF px = first_plane(cx, step_x, box.min[0]), py = first_plane(cy, step_y, box.min[1]),
     pz = first_plane(cz, step_z, box.min[2]);
  VF tx = hn::Mul(hn::Sub(px, ox), ix), ty = hn::Mul(hn::Sub(py, oy), iy),
     tz = hn::Mul(hn::Sub(pz, oz), iz);
  // The planes after those; where they are met is computed before it is known who steps.
  px = hn::Add(px, step_x), py = hn::Add(py, step_y), pz = hn::Add(pz, step_z);

  // Where lanes end is noted in registers and compared with what they have once, after the walk:
  // when a lane ends cannot be predicted.
  MF found = hn::MaskFromVec(zero);
  VF found_t = t;
  VU found_offset = offset;
  while (true) {
    const VF nx = hn::Mul(hn::Sub(px, ox), ix), ny = hn::Mul(hn::Sub(py, oy), iy),
             nz = hn::Mul(hn::Sub(pz, oz), iz);
    const VF next = hn::Min(tx, hn::Min(ty, tz));
    // A visit of no length does not count.
    const MF stops = hn::And(hn::And(active, is_solid(mask, offset)), hn::Lt(t, next));
    found = hn::Or(found, stops);
    found_t = hn::IfThenElse(stops, t, found_t);
    found_offset = hn::IfThenElse(hn::RebindMask(du, stops), offset, found_offset);
    t = hn::Max(t, next);
    // At the plane where the box ends t equals slab.exit exactly, so no index leaves it.
    active = hn::And(hn::AndNot(stops, active), hn::Lt(t, slab.exit));
    if (hn::AllFalse(df, active)) break;
    // Axes whose planes are met at the same t step together, over the edge or the corner.
    const auto step = [&](VF& plane_t, VF next_t, VF& plane, VF by, VU offset_by) HWY_ATTR {
      const MF over = hn::Le(plane_t, next);
      plane_t = hn::IfThenElse(over, next_t, plane_t);
      plane = hn::IfThenElse(over, hn::Add(plane, by), plane);
      offset = hn::IfThenElse(hn::RebindMask(du, over), hn::Add(offset, offset_by), offset);
    };
    step(tx, nx, px, step_x, offset_x);
    step(ty, ny, py, step_y, offset_y);
    step(tz, nz, pz, step_z, offset_z);
  }
  const MF hits = hn::And(found, is_nearer(found_t, ends.range, ends.primitive, leaf));
  take(hits, found_t, leaf, found_offset, ends);
  return hits;
}

// The first voxel of a leaf that is not free, from min_range on.
HWY_INLINE MF walk_leaf(const SceneData& scene, const PoseFrame& frame, const LaneRays& rays,
                        std::uint32_t leaf, const Slabs& slabs, MF active, LaneEnds& ends) {
  return walk_mask(scene, frame, scene.masks[leaf], frame.min_range, rays, leaf, slabs, active,
                   ends);
}

// The entry into a box of unknown voxels.
HWY_INLINE MF enter_box(const SceneData& scene, const PoseFrame& frame, const LaneRays& rays,
                        std::uint32_t primitive, const Slabs& slabs, MF active, LaneEnds& ends) {
  const PrimitiveBox& box = scene.boxes[primitive];
  const Interval slab = intersect_slabs(rays.ix, rays.iy, rays.iz, slabs, frame.min_range);
  const MF hits =
      hn::And(active, hn::And(hn::Lt(slab.enter, slab.exit),
                              is_nearer(slab.enter, ends.range, ends.primitive, primitive)));
  if (hn::AllFalse(df, hits)) return hits;
  // An entry point on an inner plane belongs to the side that the ray goes to: the visit of the
  // other has no length.
  const auto cell = [&](VF d, VF lo, std::size_t axis) HWY_ATTR {
    const VF p = hn::Sub(hn::Mul(d, slab.enter), lo);
    const VF floor = hn::Floor(p);
    const MF below = hn::And(hn::Lt(d, hn::Zero(df)), hn::Eq(floor, p));
    const VF index = hn::Sub(floor, hn::IfThenElseZero(below, hn::Set(df, 1.0F)));
    const VF last = hn::Set(df, (box.max[axis] - box.min[axis]) - 1.0F);
    return hn::BitCast(du, hn::ConvertTo(di, hn::Min(hn::Max(index, hn::Zero(df)), last)));
  };
  const int bits = primitive < scene.block_count ? kBlockBits : kBoxBits;
  const VU offset = hn::Or(
      hn::ShiftLeftSame(cell(rays.dx, slabs.lo_x, 0), 2 * bits),
      hn::Or(hn::ShiftLeftSame(cell(rays.dy, slabs.lo_y, 1), bits), cell(rays.dz, slabs.lo_z, 2)));
  take(hits, slab.enter, primitive, offset, ends);
  return hits;
}

// The lanes from lane0 on that a primitive ends; where, but for the range, is kept in the tile.
template <typename Kernel>
HWY_INLINE MF meet(const SceneData& scene, const PoseFrame& frame, RayTile& tile, int lane0,
                   std::uint32_t primitive, const Slabs& slabs, MF active, VF& range,
                   Kernel kernel) {
  LaneEnds ends{range, hn::Load(du, tile.primitive + lane0), hn::Load(du, tile.offset + lane0)};
  const MF hits = kernel(scene, frame, rays_of(tile, lane0), primitive, slabs, active, ends);
  range = ends.range;
  hn::Store(ends.primitive, du, tile.primitive + lane0);
  hn::Store(ends.offset, du, tile.offset + lane0);
  return hits;
}

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
