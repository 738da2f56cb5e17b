// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Leads a packet of rays through bricks, a ray a lane; compiled once for each instruction set.
//
// A step leads from where a ray enters a cube, of 1 to 128 voxels, to where it leaves it. Plane
// distances are those of leaf_walk-inl.hpp, (plane - origin) * inverse, in table coordinates, the
// plane an exact integer, so that neighbouring cubes of any size agree on where their common face
// is met. A voxel's number along the axes that are not stepped over comes from the point itself,
// kept within the cube that is left: rounding can then choose between neighbours, but never go
// back.

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

// Rounded towards zero; anything for what no integer holds. ConvertTo() takes four instructions
// more to make that the nearest integer.
HWY_INLINE VI truncated(VF v) {
#if HWY_TARGET == HWY_AVX3
  return VI{_mm512_cvttps_epi32(v.raw)};
#elif HWY_TARGET == HWY_AVX2
  return VI{_mm256_cvttps_epi32(v.raw)};
#else
  return hn::ConvertTo(di, v);
#endif
}

// One axis of a packet's rays, in table coordinates.
struct Axis {
  float origin;
  VF direction, inverse;
  VI backward;  // -1 where the ray runs towards smaller voxels, else 0
};

HWY_INLINE Axis axis_of(const BrickTable& table, const PoseFrame& frame, const float* direction,
                        const float* inverse, std::size_t a) {
  const VF i = hn::Load(df, inverse);
  return {frame.origin[a] + static_cast<float>(table.offset[a]), hn::Load(df, direction), i,
          hn::IfThenElseZero(to_i(hn::Lt(i, hn::Zero(df))), set_i(-1))};
}

// Where a point at t is, rounded towards zero: callers keep it within a cube.
HWY_INLINE VI voxel_at(const Axis& axis, VF t) {
  return truncated(hn::Add(hn::Set(df, axis.origin), hn::Mul(axis.direction, t)));
}

// Entry and exit of a box from `low` to `low + size` along an axis.
HWY_INLINE void clip(const Axis& axis, std::int32_t low, float size, VF& enter, VF& exit) {
  const auto at = [&](float plane)
                      HWY_ATTR { return hn::Mul(hn::Set(df, plane - axis.origin), axis.inverse); };
  const VF first = at(static_cast<float>(low)), last = at(static_cast<float>(low) + size);
  enter = hn::Max(enter, hn::Min(first, last));
  exit = hn::Min(exit, hn::Max(first, last));
}

// The voxels that rays are in.
struct Voxels {
  VI x, y, z;
};

// What the rays are in.
struct Place {
  VU state;  // of the voxel, as in BrickTable
  VI edge;   // of a cube round it that is the same throughout
};

// The cube of 2³ voxels of each voxel in its brick, as `states` has them.
HWY_INLINE VI cube_in_brick(const Voxels& at) {
  const VI six = set_i(6);
  return hn::Or(hn::Or(hn::ShiftLeft<3>(hn::And(at.x, six)), hn::ShiftLeft<1>(hn::And(at.y, six))),
                hn::ShiftRight<1>(hn::And(at.z, six)));
}

// Finds what voxels are in, from step to step.
class Finder {
 public:
  HWY_INLINE void begin(const BrickTable& table, const Voxels& at, bool by_voxel) {
    table_ = &table;
    largest_ = by_voxel ? 1 : 1 << table.rate_shift;
    find_nodes(at);
  }

  // `moved` has the bits in which the voxels' numbers are not those of a step before, by any axis.
  HWY_INLINE Place find(const Voxels& at, VI moved, MF active) {
    if (!hn::AllTrue(di, hn::Lt(moved, set_i(kNode)))) find_nodes(at);
    const VI mask = set_i(0x78);
    const VI brick =
        hn::Or(hn::Or(hn::ShiftLeft<5>(hn::And(at.x, mask)), hn::ShiftLeft<1>(hn::And(at.y, mask))),
               hn::ShiftRight<3>(hn::And(at.z, mask)));
    entry_ = as_i(hn::GatherIndex(du, table_->entries.data(), hn::Add(first_, brick)));
    cube_ = cube_in_brick(at);
    const VU kind = hn::ShiftRight<30>(as_u(entry_));
    // A free brick's entry is the edge. For unknown voxels it is at most that of one hazard.
    static_assert(BrickTable::kFree == 0 && BrickTable::kMixed == 2);
    const MI is_free = hn::RebindMask(di, hn::Eq(kind, hn::Zero(du)));
    const MI is_mixed = hn::Lt(entry_, hn::Zero(di));
    Place place{kind, hn::IfThenElse(is_free, entry_, set_i(largest_))};
    if (!hn::AllFalse(df, hn::And(active, to_f(is_mixed)))) within_brick(at, is_mixed, place);
    return place;
  }

  // The signed rates [1/voxel] of the hazard cells that lanes in unknown voxels are in.
  [[nodiscard]] HWY_INLINE VF rates(const Voxels& at, MF lanes) const {
    const int shift = table_->rate_shift, bits = 3 - shift;
    const VI payload = set_i(static_cast<std::int32_t>(BrickTable::kPayload));
    const VI slot = hn::IfThenElseZero(to_i(lanes), hn::And(entry_, payload));
    VI cell = cube_;
    if (shift != 1) {
      const auto cell_of = [&](VI v)
                               HWY_ATTR { return hn::ShiftRightSame(hn::And(v, set_i(7)), shift); };
      cell = hn::Or(hn::Or(hn::ShiftLeftSame(cell_of(at.x), 2 * bits),
                           hn::ShiftLeftSame(cell_of(at.y), bits)),
                    cell_of(at.z));
    }
    return hn::GatherIndex(df, table_->rates.data(),
                           hn::Add(hn::ShiftLeftSame(slot, 3 * bits), cell));
  }

  // Lanes that are in the hazard cell that they were in a step before.
  [[nodiscard]] HWY_INLINE MF in_same_cell(VI moved) const {
    return to_f(hn::Lt(moved, set_i(1 << table_->rate_shift)));
  }

 private:
  static constexpr std::int32_t kNode = 128;

  HWY_INLINE void find_nodes(const Voxels& at) {
    const VI node =
        hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<7>(at.x), set_i(table_->nodes[1])),
                                hn::ShiftRight<7>(at.y)),
                        set_i(table_->nodes[2])),
                hn::ShiftRight<7>(at.z));
    first_ = as_i(hn::GatherIndex(du, table_->node_entries.data(), node));
  }

  // In a brick that is neither free nor unknown: the voxel's own state, and the edge of the cube
  // round it, which stands above the 16 states of its cube of 2³.
  HWY_INLINE void within_brick(const Voxels& at, MI is_mixed, Place& place) const {
    const VI one = set_i(1);
    const VI slot = hn::IfThenElseZero(is_mixed, entry_);
    const VU states =
        hn::GatherIndex(du, table_->states.data(), hn::Add(hn::ShiftLeft<6>(slot), cube_));
    const VI bit =
        hn::Or(hn::Or(hn::ShiftLeft<3>(hn::And(at.x, one)), hn::ShiftLeft<2>(hn::And(at.y, one))),
               hn::ShiftLeft<1>(hn::And(at.z, one)));
    const VU own = hn::And(hn::Shr(states, as_u(bit)), hn::Set(du, 3U));
    VI edge = as_i(hn::ShiftRight<16>(states));
    const MI is_unknown = hn::RebindMask(di, hn::Eq(own, hn::Set(du, BrickTable::kUnknownVoxel)));
    edge = hn::IfThenElse(is_unknown, hn::Min(edge, set_i(largest_)), edge);
    place.state = hn::IfThenElse(hn::RebindMask(du, is_mixed), own, place.state);
    place.edge = hn::IfThenElse(is_mixed, edge, place.edge);
  }

  const BrickTable* table_ = nullptr;
  std::int32_t largest_ = 1;  // cube of unknown voxels
  VI first_;                  // entry of each lane's node
  VI entry_;                  // of its brick
  VI cube_;
};

// What a step leads through.
struct Step {
  const Finder& finder;
  const Place& place;
  const Voxels& at;
  VI moved;    // see Finder
  MF counts;   // lanes for which it has a length
  VF t, next;  // from where to where

  [[nodiscard]] HWY_INLINE MF is_in(std::uint32_t state) const {
    return hn::And(counts, hn::RebindMask(df, hn::Eq(place.state, hn::Set(du, state))));
  }
};

// How far each ray may go, from where it can meet anything.
struct Reach {
  VF begin, end;
};

HWY_INLINE Reach reach_of(const BrickTable& table, const PoseFrame& frame, const WalkLimits& limits,
                          const Axis& x, const Axis& y, const Axis& z, VF near, VF far) {
  VF enter = hn::Max(near, hn::Set(df, frame.min_range)), exit = far;
  clip(x, table.offset[0], limits.workspace[0], enter, exit);
  clip(y, table.offset[1], limits.workspace[1], enter, exit);
  clip(z, table.offset[2], limits.workspace[2], enter, exit);
  if (limits.has_plane) {
    const VF down = hn::Add(hn::Add(hn::Mul(hn::Set(df, limits.normal[0]), x.direction),
                                    hn::Mul(hn::Set(df, limits.normal[1]), y.direction)),
                            hn::Mul(hn::Set(df, limits.normal[2]), z.direction));
    const float above = limits.normal[0] * frame.origin[0] + limits.normal[1] * frame.origin[1] +
                        limits.normal[2] * frame.origin[2] - limits.height;
    const MF meets = hn::Lt(down, hn::Zero(df));
    const VF at = hn::Div(hn::Set(df, -above), hn::IfThenElse(meets, down, hn::Set(df, -1.0F)));
    if (above >= 0) exit = hn::IfThenElse(meets, hn::Min(exit, at), exit);
  }
  return {enter, exit};
}

// A packet on its way. Calls sink.step() for each cube that its rays go through.
template <typename Sink>
class PacketWalk {
 public:
  // False if no ray goes anywhere.
  HWY_INLINE bool begin(const BrickTable& table, const PoseFrame& frame, const WalkLimits& limits,
                        const WalkTask& task, int lane0) {
    const RayTile& rays = task.rays;
    x_ = axis_of(table, frame, rays.dx + lane0, rays.ix + lane0, 0);
    y_ = axis_of(table, frame, rays.dy + lane0, rays.iy + lane0, 1);
    z_ = axis_of(table, frame, rays.dz + lane0, rays.iz + lane0, 2);
    const Reach reach = reach_of(table, frame, limits, x_, y_, z_, hn::Load(df, rays.range + lane0),
                                 hn::Load(df, task.far + lane0));
    t_ = reach.begin;
    end_ = reach.end;
    const VU lane_bits = hn::Shl(hn::Set(du, 1U), hn::Iota(du, static_cast<std::uint32_t>(lane0)));
    active_ = hn::And(hn::RebindMask(df, hn::TestBit(hn::Set(du, rays.hit), lane_bits)),
                      hn::Lt(t_, end_));
    if (hn::AllFalse(df, active_)) return false;
    const auto first_voxel = [&](const Axis& axis, std::size_t a) HWY_ATTR {
      const VI low = set_i(table.offset[a]);
      const VI last = set_i(table.offset[a] + static_cast<std::int32_t>(limits.workspace[a]) - 1);
      return hn::IfThenElse(to_i(active_), hn::Min(hn::Max(voxel_at(axis, t_), low), last), low);
    };
    at_ = {first_voxel(x_, 0), first_voxel(y_, 1), first_voxel(z_, 2)};
    moved_ = hn::Zero(di);
    finder_.begin(table, at_, Sink::kByVoxel);
    return true;
  }

  // False if no ray goes on.
  HWY_INLINE bool step(Sink& sink) {
    const Place place = finder_.find(at_, moved_, active_);
    const VI top = hn::Sub(place.edge, set_i(1));
    const Along x = along(x_, at_.x, place.edge, top), y = along(y_, at_.y, place.edge, top),
                z = along(z_, at_.z, place.edge, top);
    const VF exit = hn::Min(x.leaves, hn::Min(y.leaves, z.leaves));
    const VF next = hn::Max(t_, hn::Min(exit, end_));
    const MF counts = hn::And(active_, hn::Lt(t_, next));
    const MF ends = sink.step({finder_, place, at_, moved_, counts, t_, next});
    active_ = hn::AndNot(ends, hn::And(active_, hn::Lt(exit, end_)));
    if (hn::AllFalse(df, active_)) return false;
    t_ = next;
    const auto advance = [&](const Axis& axis, VI v, const Along& a) HWY_ATTR {
      const VI inside = hn::Min(hn::Max(voxel_at(axis, next), a.low), hn::Or(v, top));
      const VI moved = hn::IfThenElse(to_i(hn::Le(a.leaves, exit)), a.over, inside);
      return hn::IfThenElse(to_i(active_), moved, v);
    };
    const Voxels before = at_;
    at_ = {advance(x_, at_.x, x), advance(y_, at_.y, y), advance(z_, at_.z, z)};
    moved_ = hn::Or(hn::Or(hn::Xor(at_.x, before.x), hn::Xor(at_.y, before.y)),
                    hn::Xor(at_.z, before.z));
    return true;
  }

 private:
  // How a cube is left along an axis: its lowest voxel, the voxel behind it, and where on the ray.
  struct Along {
    VI low, over;
    VF leaves;
  };
  static HWY_INLINE Along along(const Axis& axis, VI v, VI edge, VI top) {
    const VI low = hn::AndNot(top, v);
    const VI over = hn::Add(low, hn::Or(edge, axis.backward));
    const VF plane = hn::ConvertTo(df, hn::Sub(over, axis.backward));
    return {low, over, hn::Mul(hn::Sub(plane, hn::Set(df, axis.origin)), axis.inverse)};
  }

  Axis x_, y_, z_;
  VF t_, end_;
  MF active_;
  Voxels at_;
  VI moved_;
  Finder finder_;
};

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
