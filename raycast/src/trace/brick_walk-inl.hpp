// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Leads a packet of rays through bricks, a ray a lane; compiled once for each instruction set.
//
// A step leads from where a ray enters a cube, of 1 to 128 voxels, to where it leaves it. Plane
// distances are those of leaf_walk-inl.hpp: (plane - origin) * inverse, the plane an exact integer,
// so that neighbouring cubes of any size agree on where their common face is met. A voxel's number
// along the axes that are not stepped over comes from the point itself, kept within the cube that
// is left: rounding can then choose between neighbours, but never go back.

// Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_BRICK_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_BRICK_WALK_INL_HPP
#undef VIEWGAIN_BRICK_WALK_INL_HPP
#else
#define VIEWGAIN_BRICK_WALK_INL_HPP
#endif

#include <hwy/highway.h>

#include "lanes-inl.hpp"
#include "ordered_walk.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE VI set_i(std::int32_t v) { return hn::Set(di, v); }
HWY_INLINE VU as_u(VI v) { return hn::BitCast(du, v); }
HWY_INLINE VI as_i(VU v) { return hn::BitCast(di, v); }
HWY_INLINE MI to_i(MF m) { return hn::RebindMask(di, m); }
HWY_INLINE MF to_f(MI m) { return hn::RebindMask(df, m); }

// One axis of a packet's rays.
struct Axis {
  VF origin, direction, inverse;
  VI forward;  // 1 where the ray runs towards larger voxels, else 0
  VI offset;   // table coordinate of the workspace's lowest voxel
};

HWY_INLINE Axis axis_of(const BrickTable& table, const PoseFrame& frame, const float* direction,
                        const float* inverse, std::size_t a) {
  const VF i = hn::Load(df, inverse);
  const VI forward = hn::IfThenElse(to_i(hn::Lt(i, hn::Zero(df))), hn::Zero(di), set_i(1));
  return {hn::Set(df, frame.origin[a]), hn::Load(df, direction), i, forward,
          set_i(table.offset[a])};
}

// The voxel of a point at t, in table coordinates.
HWY_INLINE VI voxel_at(const Axis& axis, VF t) {
  const VF p = hn::Add(axis.origin, hn::Mul(axis.direction, t));
  return hn::Add(hn::ConvertTo(di, hn::Floor(p)), axis.offset);
}

// Entry and exit of a box from 0 to `size` along an axis.
HWY_INLINE void clip(const Axis& axis, float size, VF& enter, VF& exit) {
  const VF low = hn::Mul(hn::Sub(hn::Zero(df), axis.origin), axis.inverse);
  const VF high = hn::Mul(hn::Sub(hn::Set(df, size), axis.origin), axis.inverse);
  enter = hn::Max(enter, hn::Min(low, high));
  exit = hn::Min(exit, hn::Max(low, high));
}

// What the rays are in.
struct Place {
  VU state;  // of the voxel, as in BrickTable
  VI shift;  // log2 of the edge of a cube round it that is the same throughout
  VF rate;   // [1/voxel], signed
};

// What voxels are in, and for unknown ones the cube of one hazard.
HWY_INLINE Place look_up(const BrickTable& table, VI x, VI y, VI z, bool by_voxel) {
  const VI node = hn::Add(
      hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<7>(x), set_i(table.nodes[1])), hn::ShiftRight<7>(y)),
              set_i(table.nodes[2])),
      hn::ShiftRight<7>(z));
  const VU first = hn::GatherIndex(du, table.node_entries.data(), node);
  const VI fifteen = set_i(15), seven = set_i(7), three = set_i(3), one = set_i(1);
  const VI brick = hn::Or(hn::Or(hn::ShiftLeft<8>(hn::And(hn::ShiftRight<3>(x), fifteen)),
                                 hn::ShiftLeft<4>(hn::And(hn::ShiftRight<3>(y), fifteen))),
                          hn::And(hn::ShiftRight<3>(z), fifteen));
  const VU entry = hn::GatherIndex(du, table.entries.data(), hn::Add(as_i(first), brick));
  const VU kind = hn::ShiftRight<30>(entry);
  const VI payload = as_i(hn::And(entry, hn::Set(du, BrickTable::kPayload)));
  const MI is_free = hn::RebindMask(di, hn::Eq(kind, hn::Set(du, BrickTable::kFree)));
  const MI is_mixed = hn::RebindMask(di, hn::Eq(kind, hn::Set(du, BrickTable::kMixed)));
  const VI slot = hn::IfThenZeroElse(is_free, payload);

  // The rate of the hazard cell; lanes in free space read the first one.
  const int shift = table.rate_shift, bits = 3 - shift;
  const auto cell_of = [&](VI v) HWY_ATTR { return hn::ShiftRightSame(hn::And(v, seven), shift); };
  const VI cell =
      hn::Or(hn::Or(hn::ShiftLeftSame(cell_of(x), 2 * bits), hn::ShiftLeftSame(cell_of(y), bits)),
             cell_of(z));
  const VF rate =
      hn::GatherIndex(df, table.rates.data(), hn::Add(hn::ShiftLeftSame(slot, 3 * bits), cell));
  // In a brick that is neither: the voxel's own state, and that of the cubes of 2³ and 4³.
  const VI cube = hn::Or(hn::Or(hn::ShiftLeft<4>(hn::And(hn::ShiftRight<1>(x), three)),
                                hn::ShiftLeft<2>(hn::And(hn::ShiftRight<1>(y), three))),
                         hn::And(hn::ShiftRight<1>(z), three));
  const VI mixed_slot = hn::IfThenElseZero(is_mixed, payload);
  const VU states =
      hn::GatherIndex(du, table.states.data(), hn::Add(hn::ShiftLeft<6>(mixed_slot), cube));
  const VI bit = hn::ShiftLeft<1>(
      hn::Or(hn::Or(hn::ShiftLeft<2>(hn::And(x, one)), hn::ShiftLeft<1>(hn::And(y, one))),
             hn::And(z, one)));
  const VU own = hn::And(hn::Shr(states, as_u(bit)), hn::Set(du, 3U));
  const VU low = hn::And(states, hn::Set(du, 0xFFFFU));
  const MI same = hn::RebindMask(
      di, hn::Or(hn::Eq(low, hn::Zero(du)), hn::Eq(low, hn::Set(du, BrickTable::kAllUnknown))));
  const MI in_octant = hn::RebindMask(
      di, hn::Ne(hn::And(states, hn::Set(du, BrickTable::kFreeOctant | BrickTable::kUnknownOctant)),
                 hn::Zero(du)));
  VI edge = hn::IfThenElse(in_octant, set_i(2), hn::IfThenElse(same, one, hn::Zero(di)));

  const VU state = hn::IfThenElse(hn::RebindMask(du, is_mixed), own, kind);
  const MI is_unknown = hn::RebindMask(di, hn::Eq(state, hn::Set(du, BrickTable::kUnknownVoxel)));
  edge = hn::IfThenElse(is_free, payload, hn::IfThenElse(is_mixed, edge, set_i(3)));
  // An unknown voxel's cube is at most its hazard cell.
  const VI most = set_i(by_voxel ? 0 : shift);
  edge = hn::IfThenElse(is_unknown, hn::Min(edge, most), edge);
  return {state, edge, rate};
}

// How far each ray may go, from where it can meet anything.
struct Reach {
  VF begin, end;
};

HWY_INLINE Reach reach_of(const PoseFrame& frame, const WalkLimits& limits, const Axis& x,
                          const Axis& y, const Axis& z, VF far) {
  VF enter = hn::Set(df, frame.min_range), exit = far;
  clip(x, limits.workspace[0], enter, exit);
  clip(y, limits.workspace[1], enter, exit);
  clip(z, limits.workspace[2], enter, exit);
  if (limits.has_plane) {
    const auto along = [&](VF a, VF b, VF c) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(hn::Set(df, limits.normal[0]), a),
                             hn::Mul(hn::Set(df, limits.normal[1]), b)),
                     hn::Mul(hn::Set(df, limits.normal[2]), c));
    };
    const VF down = along(x.direction, y.direction, z.direction);
    const VF above = hn::Sub(along(x.origin, y.origin, z.origin), hn::Set(df, limits.height));
    const VF zero = hn::Zero(df);
    const MF meets = hn::And(hn::Lt(down, zero), hn::Ge(above, zero));
    const VF at = hn::Neg(hn::Div(above, hn::IfThenElse(meets, down, hn::Set(df, -1.0F))));
    exit = hn::IfThenElse(meets, hn::Min(exit, at), exit);
  }
  return {enter, exit};
}

// Calls sink.step() for each cube that the rays of a packet go through, until none goes on.
template <typename Sink>
HWY_INLINE void walk_packet(const BrickTable& table, const PoseFrame& frame,
                            const WalkLimits& limits, const RayTile& rays, int lane0,
                            const float* far, Sink& sink) {
  const Axis ax = axis_of(table, frame, rays.dx + lane0, rays.ix + lane0, 0);
  const Axis ay = axis_of(table, frame, rays.dy + lane0, rays.iy + lane0, 1);
  const Axis az = axis_of(table, frame, rays.dz + lane0, rays.iz + lane0, 2);
  const Reach reach = reach_of(frame, limits, ax, ay, az, hn::Load(df, far + lane0));
  const VU lane_bits = hn::Shl(hn::Set(du, 1U), hn::Iota(du, static_cast<std::uint32_t>(lane0)));
  MF active = hn::And(hn::RebindMask(df, hn::TestBit(hn::Set(du, rays.valid), lane_bits)),
                      hn::Lt(reach.begin, reach.end));
  if (hn::AllFalse(df, active)) return;

  VF t = reach.begin;
  const auto first_voxel = [&](const Axis& axis, float size) HWY_ATTR {
    const VI last = hn::Sub(hn::Add(axis.offset, hn::ConvertTo(di, hn::Set(df, size))), set_i(1));
    const VI v = hn::Min(hn::Max(voxel_at(axis, t), axis.offset), last);
    return hn::IfThenElse(to_i(active), v, axis.offset);
  };
  VI x = first_voxel(ax, limits.workspace[0]), y = first_voxel(ay, limits.workspace[1]),
     z = first_voxel(az, limits.workspace[2]);
  while (true) {
    const Place place = look_up(table, x, y, z, Sink::kByVoxel);
    const VU shift = as_u(place.shift);
    const auto low_of = [&](VI v)
                            HWY_ATTR { return as_i(hn::Shl(hn::Shr(as_u(v), shift), shift)); };
    const VI edge = as_i(hn::Shl(hn::Set(du, 1U), shift));
    const VI low_x = low_of(x), low_y = low_of(y), low_z = low_of(z);
    // The plane by which the cube is left along each axis, in table coordinates.
    const auto plane_of = [&](const Axis& axis, VI low) HWY_ATTR {
      return hn::Add(low, hn::IfThenElseZero(hn::Ne(axis.forward, hn::Zero(di)), edge));
    };
    const VI px = plane_of(ax, low_x), py = plane_of(ay, low_y), pz = plane_of(az, low_z);
    const auto distance = [&](const Axis& axis, VI plane) HWY_ATTR {
      const VF at = hn::ConvertTo(df, hn::Sub(plane, axis.offset));
      return hn::Mul(hn::Sub(at, axis.origin), axis.inverse);
    };
    const VF tx = distance(ax, px), ty = distance(ay, py), tz = distance(az, pz);
    const VF exit = hn::Min(tx, hn::Min(ty, tz));
    const VF next = hn::Max(t, hn::Min(exit, reach.end));
    const MF counts = hn::And(active, hn::Lt(t, next));
    const MF ends = sink.step(place, counts, t, next, x, y, z);
    active = hn::And(hn::AndNot(ends, active), hn::Lt(exit, reach.end));
    if (hn::AllFalse(df, active)) break;
    t = next;
    const VI top = hn::Sub(edge, set_i(1));
    const auto advance = [&](const Axis& axis, VI v, VI low, VI plane, VF at) HWY_ATTR {
      const VI over = hn::Sub(hn::Add(plane, axis.forward), set_i(1));
      const VI inside = hn::Min(hn::Max(voxel_at(axis, t), low), hn::Add(low, top));
      const VI moved = hn::IfThenElse(to_i(hn::Le(at, exit)), over, inside);
      return hn::IfThenElse(to_i(active), moved, v);
    };
    x = advance(ax, x, low_x, px, tx);
    y = advance(ay, y, low_y, py, ty);
    z = advance(az, z, low_z, pz, tz);
  }
  sink.finish();
}

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
