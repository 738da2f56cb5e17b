// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Leads a packet of rays through the voxels of a table in order. Compiled once for each instruction
// set.
//
// Each lane of the vectors is a ray. The table divides space into cubes of 1 to 128 voxels that are
// the same throughout. A step takes every lane through one cube, whatever its size:
//
//            step 1              2         3         4            along the rays ->
//   lane 0   |----- free 8 -----|-unk. 1-|-unk. 1-|occupied      ends at its fourth cube
//   lane 1   |- unk. 2 -|- unk. 2 -|occupied                     ends at its third, then idles
//   lane 2   |-unk. 1-|----- free 8 -----|----- free 16 -----|- unk. 2 -| ...
//            t        next
//
// In a step, the place of each lane's cube (state, edge, rate) is read (Finder), the planes are
// found at which the rays leave it, and the lanes move to the voxels behind those planes. Then the
// Sink gets the pieces: here the first column, then the second. Lanes are soon far apart, so each
// reads its own part of the table; that and the idle lanes are what a step costs.
//
// Plane distances are those of leaf_walk-inl.hpp, (plane - origin) * inverse, in table coordinates,
// the plane an exact integer. So neighbouring cubes of any size agree on where their common face is
// met. Along the axes that are not stepped over, a voxel's number comes from the point itself, kept
// within the cube that is left: rounding can then choose between neighbours, but never go back.
//
// A Finder knows the table, a Sink what becomes of the cubes:
//   Finder: void begin(Voxels), before the first find();
//     Found find(Voxels, VI moved), which asks for the data of voxels; and, after the sink has been
//     busy with the cubes before, Place place(Found, Voxels) with their `edge`;
//   Sink: static MF ends(Place, MF counts), lanes whose ray ends in the cube;
//     void step(Finder, Step<Place>), for each cube that a packet's rays go through;
//     static constexpr bool kCountsVoxels, whether Step::voxels is asked for.

// Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_BRICK_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_BRICK_WALK_INL_HPP
#undef VIEWGAIN_BRICK_WALK_INL_HPP
#else
#define VIEWGAIN_BRICK_WALK_INL_HPP
#endif

#include <hwy/highway.h>

#include "viewgain/support/brick_index.hpp"
#include "viewgain/support/lanes-inl.hpp"
#include "viewgain/support/walk_task.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE VI set_i(std::int32_t v) { return hn::Set(di, v); }
HWY_INLINE VU as_u(VI v) { return hn::BitCast(du, v); }
HWY_INLINE VI as_i(VU v) { return hn::BitCast(di, v); }
HWY_INLINE MI to_i(MF m) { return hn::RebindMask(di, m); }
HWY_INLINE MF to_f(MI m) { return hn::RebindMask(df, m); }
HWY_INLINE MF no_lane() { return hn::MaskFromVec(hn::Zero(df)); }

// Rounds towards zero; undefined outside the range of integers. ConvertTo() takes four more
// instructions to clamp such values.
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
  VI backward;  // -1 if the direction is negative, else 0
};

// Voxel of the point at t, rounded towards zero; callers clamp it to a cube.
HWY_INLINE VI voxel_at(const Axis& axis, VF t) {
  return truncated(hn::Add(hn::Set(df, axis.origin), hn::Mul(axis.direction, t)));
}

// Clips [enter, exit] to the slab from `low` to `low + size` along an axis.
HWY_INLINE void clip(const Axis& axis, std::int32_t low, float size, VF& enter, VF& exit) {
  const auto at = [&](float plane)
                      HWY_ATTR { return hn::Mul(hn::Set(df, plane - axis.origin), axis.inverse); };
  const VF first = at(static_cast<float>(low)), last = at(static_cast<float>(low) + size);
  enter = hn::Max(enter, hn::Min(first, last));
  exit = hn::Min(exit, hn::Max(first, last));
}

// Current voxels of the rays.
struct Voxels {
  VI x, y, z;
};

// Index of each voxel's node, and of its brick within the node.
HWY_INLINE VI node_of(const BrickIndex& index, const Voxels& at) {
  return hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<7>(at.x), set_i(index.nodes[1])),
                                 hn::ShiftRight<7>(at.y)),
                         set_i(index.nodes[2])),
                 hn::ShiftRight<7>(at.z));
}
HWY_INLINE VI brick_of(const Voxels& at) {
  const VI mask = set_i(0x78);
  return hn::Or(
      hn::Or(hn::ShiftLeft<5>(hn::And(at.x, mask)), hn::ShiftLeft<1>(hn::And(at.y, mask))),
      hn::ShiftRight<3>(hn::And(at.z, mask)));
}
// Whether all rays remain in their nodes. `moved` has the bits of the voxel coordinates that the
// last step changed, for all axes together.
HWY_INLINE bool stay_in_nodes(VI moved) {
  return hn::AllTrue(di, hn::Lt(moved, set_i(BrickIndex::kNode)));
}

// One step of a packet.
template <typename Place>
struct Step {
  const Place& place;
  const Voxels& at;
  VI moved;    // see stay_in_nodes
  VI voxels;   // number of voxels, if the sink counts them
  MF counts;   // lanes in which the step has a length
  MF ends;     // lanes whose ray ends in the cube
  VF t, next;  // distances of entry and exit
};

// Walk of one packet.
template <typename Finder, typename Sink>
class PacketWalk {
 public:
  explicit HWY_INLINE PacketWalk(const Finder& finder) : finder_(finder) {}

  // False if there is no ray to walk.
  HWY_INLINE bool begin(const BrickIndex& index, const WalkLimits& limits, const WalkTask& task,
                        int lane0) {
    x_ = axis_of(index, limits, task.dx + lane0, task.ix + lane0, 0);
    y_ = axis_of(index, limits, task.dy + lane0, task.iy + lane0, 1);
    z_ = axis_of(index, limits, task.dz + lane0, task.iz + lane0, 2);
    t_ = hn::Max(hn::Load(df, task.near + lane0), hn::Set(df, limits.min_range));
    end_ = hn::Load(df, task.far + lane0);
    clip(x_, index.offset[0], limits.workspace[0], t_, end_);
    clip(y_, index.offset[1], limits.workspace[1], t_, end_);
    clip(z_, index.offset[2], limits.workspace[2], t_, end_);
    if (limits.has_plane) end_at_plane(limits);
    active_ = hn::And(mask_of(task.lanes >> static_cast<unsigned>(lane0)), hn::Lt(t_, end_));
    if (hn::AllFalse(df, active_)) return false;
    const auto first_voxel = [&](const Axis& axis, std::size_t a) HWY_ATTR {
      const VI low = set_i(index.offset[a]), last = set_i(index.offset[a] + index.size[a] - 1);
      return hn::IfThenElse(to_i(active_), hn::Min(hn::Max(voxel_at(axis, t_), low), last), low);
    };
    at_ = {first_voxel(x_, 0), first_voxel(y_, 1), first_voxel(z_, 2)};
    moved_ = hn::Zero(di);
    finder_.begin(at_);
    found_ = finder_.find(at_, moved_);
    return true;
  }

  // False if no ray continues.
  HWY_INLINE bool step(Sink& sink) {
    const typename Finder::Place place = finder_.place(found_, at_);
    const VI top = hn::Sub(place.edge, set_i(1));
    const Along x = along(x_, at_.x, place.edge, top), y = along(y_, at_.y, place.edge, top),
                z = along(z_, at_.z, place.edge, top);
    const VF exit = hn::Min(x.leaves, hn::Min(y.leaves, z.leaves));
    const VF t = t_, next = hn::Max(t, hn::Min(exit, end_));
    const MF counts = hn::And(active_, hn::Lt(t, next));
    VI voxels = set_i(1);
    const auto advance = [&](const Axis& axis, VI v, const Along& a) HWY_ATTR {
      const VI inside = hn::Min(hn::Max(voxel_at(axis, next), a.low), hn::Or(v, top));
      const MI crosses = to_i(hn::Le(a.leaves, hn::Min(exit, end_)));
      if constexpr (Sink::kCountsVoxels) {
        const VI last =
            hn::IfThenElse(crosses, hn::Sub(a.over, hn::Or(axis.backward, set_i(1))), inside);
        voxels = hn::Add(voxels, hn::Abs(hn::Sub(last, v)));
      }
      return hn::IfThenElse(crosses, a.over, inside);
    };
    const Voxels at = at_, beyond{advance(x_, at.x, x), advance(y_, at.y, y), advance(z_, at.z, z)};
    const VI moved = moved_;
    const MF ends = Sink::ends(place, counts);
    active_ = hn::AndNot(ends, hn::And(active_, hn::Lt(exit, end_)));
    const bool any = !hn::AllFalse(df, active_);
    if (any) {
      t_ = next;
      at_ = {hn::IfThenElse(to_i(active_), beyond.x, at.x),
             hn::IfThenElse(to_i(active_), beyond.y, at.y),
             hn::IfThenElse(to_i(active_), beyond.z, at.z)};
      moved_ = hn::Or(hn::Or(hn::Xor(at_.x, at.x), hn::Xor(at_.y, at.y)), hn::Xor(at_.z, at.z));
      // What is asked for here is read in the next step, when the sink has been busy.
      found_ = finder_.find(at_, moved_);
    }
    sink.step(finder_,
              Step<typename Finder::Place>{place, at, moved, voxels, counts, ends, t, next});
    return any;
  }

  // Distances at which the rays end at the latest.
  [[nodiscard]] HWY_INLINE VF end() const { return end_; }

 private:
  // Exit from a cube along an axis: the cube's lowest voxel, the next voxel behind it, and the
  // distance.
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

  static HWY_INLINE Axis axis_of(const BrickIndex& index, const WalkLimits& limits,
                                 const float* direction, const float* inverse, std::size_t a) {
    const VF i = hn::Load(df, inverse);
    return {limits.origin[a] + static_cast<float>(index.offset[a]), hn::Load(df, direction), i,
            hn::IfThenElseZero(to_i(hn::Lt(i, hn::Zero(df))), set_i(-1))};
  }

  // Descending rays from above the plane end there.
  HWY_INLINE void end_at_plane(const WalkLimits& limits) {
    const std::array<float, 3>& n = limits.normal;
    const VF down = hn::Add(
        hn::Add(hn::Mul(hn::Set(df, n[0]), x_.direction), hn::Mul(hn::Set(df, n[1]), y_.direction)),
        hn::Mul(hn::Set(df, n[2]), z_.direction));
    const float above =
        n[0] * limits.origin[0] + n[1] * limits.origin[1] + n[2] * limits.origin[2] - limits.height;
    const MF meets = hn::Lt(down, hn::Zero(df));
    const VF at = hn::Div(hn::Set(df, -above), hn::IfThenElse(meets, down, hn::Set(df, -1.0F)));
    if (above >= 0) end_ = hn::IfThenElse(meets, hn::Min(end_, at), end_);
  }

  Finder finder_;
  Axis x_, y_, z_;
  VF t_, end_;
  MF active_;
  Voxels at_;
  VI moved_;
  typename Finder::Found found_;
};

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
