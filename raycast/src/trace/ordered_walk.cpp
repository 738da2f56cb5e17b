// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What rays meet on their way through unknown voxels: sums of expected area, or lists of voxels.
// Compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/ordered_walk.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include "brick_walk-inl.hpp"
#include "ordered_walk.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// 1 - exp(-x) for x >= 0, to some units in the last place also where x is small.
HWY_INLINE VF one_minus_exp(VF x) {
  const VF most = hn::Set(df, 80.0F);
  x = hn::Min(x, most);
  const VF n = hn::Round(hn::Mul(x, hn::Set(df, 1.44269504F)));
  // x - n ln 2 in two parts
  VF r = hn::Sub(x, hn::Mul(n, hn::Set(df, 0.693145752F)));
  r = hn::Sub(r, hn::Mul(n, hn::Set(df, 1.42860677e-6F)));
  // 1 - exp(-r) = r - r²/2! + r³/3! - ..., |r| <= 0.35
  VF q = hn::Set(df, 1.0F / 5040.0F);
  const auto next = [&](float c) HWY_ATTR { q = hn::Sub(hn::Set(df, c), hn::Mul(r, q)); };
  next(1.0F / 720.0F);
  next(1.0F / 120.0F);
  next(1.0F / 24.0F);
  next(1.0F / 6.0F);
  next(0.5F);
  next(1.0F);
  q = hn::Mul(r, q);
  // 2^-n (1 - q)
  const VI exponent = hn::Sub(set_i(127), hn::ConvertTo(di, n));
  const VF scale = hn::BitCast(df, hn::ShiftLeft<23>(exponent));
  return hn::Add(hn::Sub(hn::Set(df, 1.0F), scale), hn::Mul(scale, q));
}

HWY_INLINE MF has_state(const Place& place, std::uint32_t state) {
  return hn::RebindMask(df, hn::Eq(place.state, hn::Set(du, state)));
}

// Sums expected area. A run is what a ray has of one hazard cell in one piece: it is closed when
// the next piece belongs to another cell or does not follow on.
class AreaSink {
 public:
  static constexpr bool kByVoxel = false;

  HWY_INLINE AreaSink(const float* solid_angle, float cap, int rate_shift)
      : angle_(hn::LoadU(df, solid_angle)), cap_(hn::Set(df, cap)), shift_(rate_shift) {}

  HWY_INLINE MF step(const Place& place, MF counts, VF t, VF next, VI x, VI y, VI z) {
    const MF unknown = hn::And(counts, has_state(place, BrickTable::kUnknownVoxel));
    const MF occupied = hn::And(counts, has_state(place, BrickTable::kOccupiedVoxel));
    const MF known = hn::AndNot(unknown, counts);
    // Which hazard cell, apart from its neighbours.
    const auto part = [&](VI v)
                          HWY_ATTR { return hn::And(hn::ShiftRightSame(v, shift_), set_i(1023)); };
    const VI cell = hn::Or(hn::Or(hn::ShiftLeft<20>(part(x)), hn::ShiftLeft<10>(part(y))), part(z));
    const MF goes_on = hn::And(unknown, hn::And(to_f(hn::Eq(cell, cell_)), hn::Eq(t, end_)));
    const MF closes = hn::And(open_, hn::Or(known, hn::AndNot(goes_on, unknown)));
    if (!hn::AllFalse(df, closes)) close(closes);
    const MF opens = hn::AndNot(goes_on, unknown);
    // A stretch begins where unknown follows on anything else.
    const MF begins = hn::AndNot(in_stretch_, unknown);
    stretch_begin_ = hn::IfThenElse(begins, t, stretch_begin_);
    stretch_passed_ = hn::IfThenElse(begins, passed_, stretch_passed_);
    stretch_area_ = hn::IfThenElse(begins, hn::Zero(df), stretch_area_);
    const MF free = hn::AndNot(occupied, known);
    in_stretch_ = hn::AndNot(free, hn::Or(in_stretch_, unknown));

    begin_ = hn::IfThenElse(opens, t, begin_);
    end_ = hn::IfThenElse(unknown, next, end_);
    rate_ = hn::IfThenElse(opens, place.rate, rate_);
    cell_ = hn::IfThenElse(to_i(opens), cell, cell_);
    open_ = hn::Or(unknown, hn::AndNot(known, open_));

    range_ = hn::IfThenElse(occupied, t, range_);
    x_ = hn::IfThenElse(to_i(occupied), x, x_);
    y_ = hn::IfThenElse(to_i(occupied), y, y_);
    z_ = hn::IfThenElse(to_i(occupied), z, z_);
    occupied_ = hn::Or(occupied_, occupied);
    return occupied;
  }

  HWY_INLINE void finish() { close(open_); }

  HWY_INLINE void store(int lane0, WalkedTile& out) const {
    hn::Store(passed_, df, out.passed + lane0);
    hn::Store(area_, df, out.area + lane0);
    hn::Store(hn::IfThenElseZero(in_stretch_, stretch_area_), df, out.stretch_area + lane0);
    hn::Store(stretch_passed_, df, out.stretch_passed + lane0);
    hn::Store(hn::IfThenElseZero(in_stretch_, hn::Sub(range_, stretch_begin_)), df,
              out.stretch_length + lane0);
    hn::Store(range_, df, out.range + lane0);
    hn::Store(x_, di, out.x + lane0);
    hn::Store(y_, di, out.y + lane0);
    hn::Store(z_, di, out.z + lane0);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(df, occupied_, bits);
    out.occupied |=
        (static_cast<std::uint32_t>(bits[0]) | static_cast<std::uint32_t>(bits[1]) << 8U) << lane0;
  }

 private:
  HWY_INLINE void close(MF lanes) {
    const VF length = hn::Sub(end_, begin_);
    const VF p = one_minus_exp(hn::Mul(hn::Abs(rate_), length));
    const VF share = hn::IfThenElseZero(lanes, hn::Mul(passed_, p));  // P
    const VF t = hn::Mul(hn::Set(df, 0.5F), hn::Add(begin_, end_));
    const VF across = hn::Min(hn::Mul(angle_, hn::Mul(t, t)), cap_);
    const MF is_known =
        hn::RebindMask(df, hn::TestBit(hn::BitCast(du, rate_), hn::Set(du, 0x80000000U)));
    const VF more = hn::IfThenZeroElse(is_known, hn::Mul(share, across));
    area_ = hn::Add(area_, more);
    stretch_area_ = hn::Add(stretch_area_, more);
    passed_ = hn::Sub(passed_, share);
  }

  VF angle_, cap_;
  int shift_;
  VF passed_ = hn::Set(df, 1.0F), area_ = hn::Zero(df);
  // The run that is open.
  MF open_ = hn::MaskFromVec(hn::Zero(df));
  VF begin_ = hn::Zero(df), end_ = hn::Zero(df), rate_ = hn::Zero(df);
  VI cell_ = hn::Zero(di);
  // The stretch of unknown voxels that the ray is in.
  MF in_stretch_ = hn::MaskFromVec(hn::Zero(df));
  VF stretch_begin_ = hn::Zero(df), stretch_passed_ = hn::Zero(df), stretch_area_ = hn::Zero(df);
  // Where it ends.
  MF occupied_ = hn::MaskFromVec(hn::Zero(df));
  VF range_ = hn::Zero(df);
  VI x_ = hn::Zero(di), y_ = hn::Zero(di), z_ = hn::Zero(di);
};

// Writes down each voxel.
class VisitSink {
 public:
  static constexpr bool kByVoxel = true;

  VisitSink(int lane0, std::vector<VoxelVisit>& out) : lane0_(lane0), out_(out) {}

  HWY_INLINE MF step(const Place& place, MF counts, VF t, VF next, VI x, VI y, VI z) {
    const MF occupied = hn::And(counts, has_state(place, BrickTable::kOccupiedVoxel));
    const MF wanted =
        hn::Or(occupied, hn::And(counts, has_state(place, BrickTable::kUnknownVoxel)));
    if (hn::AllFalse(df, wanted)) return occupied;
    HWY_ALIGN float begins[kWidth], ends[kWidth], rates[kWidth];
    HWY_ALIGN std::int32_t xs[kWidth], ys[kWidth], zs[kWidth];
    HWY_ALIGN std::uint32_t states[kWidth];
    hn::Store(t, df, begins);
    hn::Store(next, df, ends);
    hn::Store(place.rate, df, rates);
    hn::Store(x, di, xs);
    hn::Store(y, di, ys);
    hn::Store(z, di, zs);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(du, wanted), place.state), du, states);
    for (int i = 0; i < kWidth; ++i) {
      if (states[i] == BrickTable::kFreeVoxel) continue;
      out_.push_back({static_cast<std::uint32_t>(lane0_ + i), states[i], xs[i], ys[i], zs[i],
                      begins[i], ends[i], rates[i]});
    }
    return occupied;
  }
  HWY_INLINE void finish() {}

 private:
  int lane0_;
  std::vector<VoxelVisit>& out_;
};

void area(const BrickTable& table, const PoseFrame& frame, const WalkLimits& limits,
          const RayTile& rays, const float* far, const float* solid_angle, float cap,
          WalkedTile& out) {
  out.occupied = 0;
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    AreaSink sink(solid_angle + lane0, cap, table.rate_shift);
    walk_packet(table, frame, limits, rays, lane0, far, sink);
    sink.store(lane0, out);
  }
}

void visits(const BrickTable& table, const PoseFrame& frame, const WalkLimits& limits,
            const RayTile& rays, const float* far, std::vector<VoxelVisit>& out) {
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    VisitSink sink(lane0, out);
    walk_packet(table, frame, limits, rays, lane0, far, sink);
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

const WalkKernels& walk_kernels(Isa isa) {
  switch (isa) {
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::ordered_walk_kernels();
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::ordered_walk_kernels();
#endif
    default:
      return HWY_STATIC_DISPATCH(ordered_walk_kernels)();
  }
}

}  // namespace viewgain::detail
#endif
