// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What rays meet on their way through unknown voxels: sums of expected area, or lists of voxels.
// Compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/ordered_walk.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "ordered_walk.hpp"
#include "viewgain/support/brick_walk-inl.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// The cube of 2³ voxels of each voxel in its brick, as BrickTable::states has them.
HWY_INLINE VI cube_in_brick(const Voxels& at) {
  const VI six = set_i(6);
  return hn::Or(hn::Or(hn::ShiftLeft<3>(hn::And(at.x, six)), hn::ShiftLeft<1>(hn::And(at.y, six))),
                hn::ShiftRight<1>(hn::And(at.z, six)));
}

// Finds states and hazard.
class HazardFinder {
 public:
  struct Place {
    VU state;  // of the voxel, as in BrickTable
    VI edge;
    VI entry;  // of its brick
    VI cube;
  };

  HWY_INLINE HazardFinder(const BrickTable& table, bool by_voxel)
      : table_(table), largest_(by_voxel ? 1 : 1 << table.rate_shift) {}

  HWY_INLINE void begin(const Voxels& at) { find_nodes(at); }

  HWY_INLINE Place find(const Voxels& at, VI moved, MF active) {
    if (!stay_in_nodes(moved)) find_nodes(at);
    const VI entry =
        as_i(hn::GatherIndex(du, table_.entries.data(), hn::Add(first_, brick_of(at))));
    const VU kind = hn::ShiftRight<30>(as_u(entry));
    // A free brick's entry is the edge. For unknown voxels it is at most that of one hazard.
    static_assert(BrickTable::kFree == 0 && BrickTable::kMixed == 2);
    const MI is_free = hn::RebindMask(di, hn::Eq(kind, hn::Zero(du)));
    const MI is_mixed = hn::Lt(entry, hn::Zero(di));
    Place place{kind, hn::IfThenElse(is_free, entry, set_i(largest_)), entry, cube_in_brick(at)};
    if (!hn::AllFalse(df, hn::And(active, to_f(is_mixed)))) within_brick(at, is_mixed, place);
    return place;
  }

  [[nodiscard]] static HWY_INLINE MF is_in(const Place& place, std::uint32_t state, MF lanes) {
    return hn::And(lanes, hn::RebindMask(df, hn::Eq(place.state, hn::Set(du, state))));
  }

  // Where BrickTable::rates has the hazard cells that lanes in unknown voxels are in.
  [[nodiscard]] HWY_INLINE VI rate_places(const Place& place, const Voxels& at, MF lanes) const {
    const int shift = table_.rate_shift, bits = 3 - shift;
    const VI payload = set_i(static_cast<std::int32_t>(BrickTable::kPayload));
    const VI slot = hn::IfThenElseZero(to_i(lanes), hn::And(place.entry, payload));
    VI cell = place.cube;
    if (shift != 1) {
      const auto cell_of = [&](VI v)
                               HWY_ATTR { return hn::ShiftRightSame(hn::And(v, set_i(7)), shift); };
      cell = hn::Or(hn::Or(hn::ShiftLeftSame(cell_of(at.x), 2 * bits),
                           hn::ShiftLeftSame(cell_of(at.y), bits)),
                    cell_of(at.z));
    }
    return hn::Add(hn::ShiftLeftSame(slot, 3 * bits), cell);
  }
  // Their signed rates [1/voxel].
  [[nodiscard]] HWY_INLINE VF rates(VI places) const {
    return hn::GatherIndex(df, table_.rates.data(), places);
  }

  // Is what moved so far still in its hazard cell?
  [[nodiscard]] HWY_INLINE MF in_same_cell(VI moved) const {
    return to_f(hn::Lt(moved, set_i(1 << table_.rate_shift)));
  }

 private:
  HWY_INLINE void find_nodes(const Voxels& at) {
    first_ = as_i(hn::GatherIndex(du, table_.node_entries.data(), node_of(table_, at)));
  }

  // In a brick that is neither free nor unknown: the voxel's own state, and the edge of the cube
  // round it, which stands above the 16 states of its cube of 2³.
  HWY_INLINE void within_brick(const Voxels& at, MI is_mixed, Place& place) const {
    const VI one = set_i(1);
    const VI slot = hn::IfThenElseZero(is_mixed, place.entry);
    const VU states =
        hn::GatherIndex(du, table_.states.data(), hn::Add(hn::ShiftLeft<6>(slot), place.cube));
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

  const BrickTable& table_;
  std::int32_t largest_;  // cube of unknown voxels
  VI first_;              // entry of each lane's node
};
using HazardStep = Step<HazardFinder::Place>;

// 1 - exp(-x) = x - x²/2! + x³/3! - ... for |x| <= 0.35, to some units in the last place also
// where x is small. In pairs of terms, which do not wait for each other.
HWY_INLINE VF one_minus_exp_of_small(VF x) {
  const VF square = hn::Mul(x, x);
  const auto pair = [&](float even, float odd) HWY_ATTR {
    return hn::Sub(hn::Set(df, even), hn::Mul(hn::Set(df, odd), x));
  };
  VF q = hn::Mul(square, hn::Set(df, 1.0F / 5040.0F));
  q = hn::Mul(square, hn::Add(pair(1.0F / 120.0F, 1.0F / 720.0F), q));
  q = hn::Mul(square, hn::Add(pair(1.0F / 6.0F, 1.0F / 24.0F), q));
  return hn::Mul(x, hn::Add(pair(1.0F, 0.5F), q));
}

// 1 - exp(-x) and exp(-x) for x >= 0, each to some units in its own last place.
struct Shares {
  VF ends, passes;
};
HWY_INLINE Shares shares_of(VF x) {
  constexpr float kSmall = 0.34F;
  const VF one = hn::Set(df, 1.0F);
  if (hn::AllTrue(df, hn::Le(x, hn::Set(df, kSmall)))) {
    const VF ends = one_minus_exp_of_small(x);
    return {ends, hn::Sub(one, ends)};
  }
  const VF most = hn::Set(df, 80.0F);
  x = hn::Min(x, most);
  const VF n = hn::Round(hn::Mul(x, hn::Set(df, 1.44269504F)));
  // x - n ln 2 in two parts
  VF r = hn::Sub(x, hn::Mul(n, hn::Set(df, 0.693145752F)));
  r = hn::Sub(r, hn::Mul(n, hn::Set(df, 1.42860677e-6F)));
  const VF q = one_minus_exp_of_small(r);
  // exp(-x) = 2^-n (1 - q)
  const VI exponent = hn::Sub(set_i(127), hn::ConvertTo(di, n));
  const VF scale = hn::BitCast(df, hn::ShiftLeft<23>(exponent));
  const VF rest = hn::Mul(scale, q);
  return {hn::Add(hn::Sub(one, scale), rest), hn::Sub(scale, rest)};
}

// Sums expected area. A run is what a ray has of one hazard cell in one piece. It is summed with
// its first step; what further ones add to its chance, and take its middle to, is made good then.
// What a lane has depends on its own steps alone.
template <bool kMissed>
class AreaSink {
 public:
  static constexpr bool kCountsVoxels = false;

  [[nodiscard]] static HWY_INLINE MF ends(const HazardFinder::Place& place, MF counts) {
    return HazardFinder::is_in(place, BrickTable::kOccupiedVoxel, counts);
  }

  HWY_INLINE AreaSink(const float* solid_angle, const PixelWorth& worth, const float* missed)
      : angle_(hn::Mul(hn::LoadU(df, solid_angle), hn::Set(df, worth.scale))),
        cap_(hn::Set(df, worth.cap * worth.scale)),
        one_and_s0_(hn::Set(df, 1 + worth.s0)),
        s1_(hn::Set(df, worth.s1)),
        s2_(hn::Set(df, worth.s2)),
        at_(hn::Set(df, worth.at)),
        missed_(missed) {}

  HWY_INLINE void step(const HazardFinder& finder, const HazardStep& step) {
    const MF unknown = HazardFinder::is_in(step.place, BrickTable::kUnknownVoxel, step.counts);
    const MF occupied = step.ends;
    const VF t = step.t, next = step.next;
    // A cell that a ray only touches ends its run, too.
    moved_ = hn::Or(moved_, step.moved);
    if (!hn::AllFalse(df, unknown)) {
      // A stretch begins where unknown follows on anything else.
      const MF begins = hn::AndNot(in_unknown_, unknown);
      stretch_begin_ = hn::IfThenElse(begins, t, stretch_begin_);
      stretch_passed_ = hn::IfThenElse(begins, passed_, stretch_passed_);
      stretch_area_ = hn::IfThenZeroElse(begins, stretch_area_);
      stretch_all_ = hn::IfThenZeroElse(begins, stretch_all_);
      stretch_share_ = hn::IfThenZeroElse(begins, stretch_share_);

      const VI places = finder.rate_places(step.place, step.at, unknown);
      const VF rate = finder.rates(places);
      const VF depth = hn::Mul(hn::Abs(rate), hn::Sub(next, t));
      const Shares shares = shares_of(hn::IfThenElseZero(unknown, depth));
      const VF share = hn::Mul(passed_, shares.ends);
      passed_ = hn::Mul(passed_, shares.passes);
      stretch_share_ = hn::Add(stretch_share_, share);
      const MF goes_on = hn::And(in_unknown_, finder.in_same_cell(moved_));
      const MF keeps = hn::Or(goes_on, hn::Not(unknown));
      begin_ = hn::IfThenElse(keeps, begin_, t);
      run_ = hn::Add(hn::IfThenElseZero(keeps, run_), share);  // P so far
      const VF middle = hn::Mul(hn::Set(df, 0.5F), hn::Add(begin_, next));
      VF across = hn::Div(hn::Min(hn::Mul(angle_, hn::Mul(middle, middle)), cap_), misses(middle));
      if constexpr (kMissed) across = hn::Mul(across, hn::GatherIndex(df, missed_, places));
      const VF whole = hn::Mul(run_, across);
      const VF all =
          hn::IfThenElseZero(unknown, hn::Sub(whole, hn::IfThenElseZero(goes_on, run_area_)));
      const VF more = hn::IfThenZeroElse(hn::Lt(rate, hn::Zero(df)), all);  // unless it is known
      run_area_ = hn::IfThenElse(unknown, whole, run_area_);
      area_ = hn::Add(area_, more);
      stretch_area_ = hn::Add(stretch_area_, more);
      stretch_all_ = hn::Add(stretch_all_, all);
    }
    moved_ = hn::IfThenZeroElse(to_i(step.counts), moved_);
    // Where a ray ends in a voxel it stays what it was before.
    in_unknown_ = hn::Or(unknown, hn::AndNot(hn::AndNot(occupied, step.counts), in_unknown_));
    if (!hn::AllFalse(df, occupied)) {
      range_ = hn::IfThenElse(occupied, t, range_);
      x_ = hn::IfThenElse(to_i(occupied), step.at.x, x_);
      y_ = hn::IfThenElse(to_i(occupied), step.at.y, y_);
      z_ = hn::IfThenElse(to_i(occupied), step.at.z, z_);
      occupied_ = hn::Or(occupied_, occupied);
    }
  }

  HWY_INLINE void store(int lane0, WalkedTile& out) const {
    hn::Store(passed_, df, out.passed + lane0);
    hn::Store(area_, df, out.area + lane0);
    hn::Store(hn::IfThenElseZero(in_unknown_, stretch_area_), df, out.stretch_area + lane0);
    hn::Store(hn::IfThenElseZero(in_unknown_, stretch_all_), df, out.stretch_all + lane0);
    hn::Store(hn::IfThenElseZero(hn::Gt(stretch_passed_, hn::Zero(df)),
                                 hn::Div(stretch_share_, stretch_passed_)),
              df, out.stretch_chance + lane0);
    hn::Store(hn::IfThenElseZero(in_unknown_, hn::Sub(range_, stretch_begin_)), df,
              out.stretch_length + lane0);
    hn::Store(range_, df, out.range + lane0);
    hn::Store(x_, di, out.x + lane0);
    hn::Store(y_, di, out.y + lane0);
    hn::Store(z_, di, out.z + lane0);
    out.occupied |= bits_of(occupied_) << static_cast<unsigned>(lane0);
  }

 private:
  // 1 + s
  [[nodiscard]] HWY_INLINE VF misses(VF t) const {
    const VF off = hn::Sub(t, at_);
    return hn::Add(hn::Add(one_and_s0_, hn::Mul(s1_, t)), hn::Mul(s2_, hn::Mul(off, off)));
  }

  VF angle_, cap_, one_and_s0_, s1_, s2_, at_;
  const float* missed_;
  VF passed_ = hn::Set(df, 1.0F), area_ = hn::Zero(df);
  MF in_unknown_ = no_lane();  // since the last step of any length
  VI moved_ = hn::Zero(di);    // since then
  // The run that the ray is in: where it begins, its chance and area so far.
  VF begin_ = hn::Zero(df), run_ = hn::Zero(df), run_area_ = hn::Zero(df);
  // The stretch of unknown voxels that it is in.
  VF stretch_begin_ = hn::Zero(df), stretch_passed_ = hn::Zero(df), stretch_area_ = hn::Zero(df),
     stretch_all_ = hn::Zero(df), stretch_share_ = hn::Zero(df);
  // Where it ends.
  MF occupied_ = no_lane();
  VF range_ = hn::Zero(df);
  VI x_ = hn::Zero(di), y_ = hn::Zero(di), z_ = hn::Zero(di);
};

// Writes down each voxel.
class VisitSink {
 public:
  static constexpr bool kCountsVoxels = false;

  [[nodiscard]] static HWY_INLINE MF ends(const HazardFinder::Place& place, MF counts) {
    return HazardFinder::is_in(place, BrickTable::kOccupiedVoxel, counts);
  }

  VisitSink(int lane0, std::vector<VoxelVisit>& out) : lane0_(lane0), out_(out) {}

  HWY_INLINE void step(const HazardFinder& finder, const HazardStep& step) {
    const MF unknown = HazardFinder::is_in(step.place, BrickTable::kUnknownVoxel, step.counts);
    const std::uint32_t wanted = bits_of(hn::Or(step.ends, unknown));
    if (wanted == 0) return;
    HWY_ALIGN float begins[kWidth], ends[kWidth], rates[kWidth];
    HWY_ALIGN std::int32_t xs[kWidth], ys[kWidth], zs[kWidth];
    HWY_ALIGN std::uint32_t states[kWidth];
    hn::Store(step.t, df, begins);
    hn::Store(step.next, df, ends);
    hn::Store(finder.rates(finder.rate_places(step.place, step.at, unknown)), df, rates);
    hn::Store(step.at.x, di, xs);
    hn::Store(step.at.y, di, ys);
    hn::Store(step.at.z, di, zs);
    hn::Store(step.place.state, du, states);
    for (std::uint32_t left = wanted; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      out_.push_back({static_cast<std::uint32_t>(lane0_ + i), states[i], xs[i], ys[i], zs[i],
                      begins[i], ends[i], rates[i]});
    }
  }

 private:
  int lane0_;
  std::vector<VoxelVisit>& out_;
};

template <bool kMissed>
void area_of(const BrickTable& table, const WalkLimits& limits, const WalkTask& task,
             const PixelWorth& worth, const float* missed, WalkedTile& out) {
  out.occupied = 0;
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    AreaSink<kMissed> sink(task.solid_angle + lane0, worth, missed);
    PacketWalk<HazardFinder, AreaSink<kMissed>> walk(HazardFinder(table, false));
    if (walk.begin(table, limits, task, lane0)) {
      while (walk.step(sink)) {
      }
    }
    sink.store(lane0, out);
  }
}

void area(const BrickTable& table, const WalkLimits& limits, const WalkTask& task,
          const PixelWorth& worth, const float* missed, WalkedTile& out) {
  (missed == nullptr ? area_of<false> : area_of<true>)(table, limits, task, worth, missed, out);
}

void visits(const BrickTable& table, const WalkLimits& limits, const WalkTask& task,
            std::vector<VoxelVisit>& out) {
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    VisitSink sink(lane0, out);
    PacketWalk<HazardFinder, VisitSink> walk(HazardFinder(table, true));
    if (!walk.begin(table, limits, task, lane0)) continue;
    while (walk.step(sink)) {
    }
  }
}

}  // namespace

const WalkKernels& ordered_walk_kernels() {
  static const WalkKernels table{area, visits};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

WalkLimits walk_limits(const SceneData& scene, const PoseFrame& frame) {
  const GridSnapshot& snapshot = scene.snapshot;
  WalkLimits limits;
  limits.origin = frame.origin;
  limits.min_range = frame.min_range;
  limits.workspace = {static_cast<float>(snapshot.dims.x), static_cast<float>(snapshot.dims.y),
                      static_cast<float>(snapshot.dims.z)};
  const std::optional<double>& plane = scene.surroundings->support_plane;
  if (!plane) return limits;
  const Pose T_grid_world = snapshot.T_world_grid.inverse();
  const Eigen::Vector3d normal = T_grid_world.rotation() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d base(snapshot.min_index.x, snapshot.min_index.y, snapshot.min_index.z);
  const Eigen::Vector3d on_plane =
      T_grid_world * Eigen::Vector3d(0, 0, *plane) / snapshot.voxel_size - base;
  limits.has_plane = true;
  for (Eigen::Index a = 0; a < 3; ++a) {
    limits.normal[static_cast<std::size_t>(a)] = static_cast<float>(normal[a]);
  }
  limits.height = static_cast<float>(normal.dot(on_plane));
  return limits;
}

void set_up(const TileTable& table, std::size_t number, const PoseFrame& frame, const RayTile& rays,
            WalkTask& task) {
  std::copy_n(rays.dx, kTileRays, task.dx);
  std::copy_n(rays.dy, kTileRays, task.dy);
  std::copy_n(rays.dz, kTileRays, task.dz);
  std::copy_n(rays.ix, kTileRays, task.ix);
  std::copy_n(rays.iy, kTileRays, task.iy);
  std::copy_n(rays.iz, kTileRays, task.iz);
  std::copy_n(rays.range, kTileRays, task.near);
  if (rays.has_far) {
    std::copy_n(rays.far, kTileRays, task.far);
  } else {
    std::fill_n(task.far, kTileRays, frame.max_range);
  }
  task.solid_angle = &table.solid_angle[number * kTileRays];
  task.lanes = rays.hit;
}

const WalkKernels& walk_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, ordered_walk_kernels)(); }

}  // namespace viewgain::detail
#endif
