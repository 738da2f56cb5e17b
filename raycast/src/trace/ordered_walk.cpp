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

// The same for all x >= 0.
HWY_INLINE VF one_minus_exp(VF x) {
  constexpr float kSmall = 0.34F;
  if (hn::AllTrue(df, hn::Le(x, hn::Set(df, kSmall)))) return one_minus_exp_of_small(x);
  const VF most = hn::Set(df, 80.0F);
  x = hn::Min(x, most);
  const VF n = hn::Round(hn::Mul(x, hn::Set(df, 1.44269504F)));
  // x - n ln 2 in two parts
  VF r = hn::Sub(x, hn::Mul(n, hn::Set(df, 0.693145752F)));
  r = hn::Sub(r, hn::Mul(n, hn::Set(df, 1.42860677e-6F)));
  const VF q = one_minus_exp_of_small(r);
  // 2^-n (1 - q)
  const VI exponent = hn::Sub(set_i(127), hn::ConvertTo(di, n));
  const VF scale = hn::BitCast(df, hn::ShiftLeft<23>(exponent));
  return hn::Add(hn::Sub(hn::Set(df, 1.0F), scale), hn::Mul(scale, q));
}

// Sums expected area. A run is what a ray has of one hazard cell in one piece. It is summed with
// its first step; what further ones add to its chance, and take its middle to, is made good then.
class AreaSink {
 public:
  static constexpr bool kByVoxel = false;

  HWY_INLINE AreaSink(const float* solid_angle, float cap)
      : angle_(hn::LoadU(df, solid_angle)), cap_(hn::Set(df, cap)) {}

  HWY_INLINE MF step(const Step& step) {
    const MF unknown = step.is_in(BrickTable::kUnknownVoxel);
    const MF occupied = step.is_in(BrickTable::kOccupiedVoxel);
    const VF t = step.t, next = step.next;
    if (!hn::AllFalse(df, unknown)) {
      // A stretch begins where unknown follows on anything else.
      const MF begins = hn::AndNot(in_unknown_, unknown);
      stretch_begin_ = hn::IfThenElse(begins, t, stretch_begin_);
      stretch_passed_ = hn::IfThenElse(begins, passed_, stretch_passed_);
      stretch_area_ = hn::IfThenElse(begins, hn::Zero(df), stretch_area_);

      const VF rate = step.finder.rates(step.at, unknown);
      const VF depth = hn::Mul(hn::Abs(rate), hn::Sub(next, t));
      const VF share = hn::Mul(passed_, one_minus_exp(hn::IfThenElseZero(unknown, depth)));
      passed_ = hn::Sub(passed_, share);
      const MF goes_on =
          hn::And(hn::And(unknown, in_unknown_), step.finder.in_same_cell(step.moved));
      begin_ = hn::IfThenElse(goes_on, begin_, t);
      run_ = hn::Add(hn::IfThenElseZero(goes_on, run_), share);  // P so far
      const VF middle = hn::Mul(hn::Set(df, 0.5F), hn::Add(begin_, next));
      const VF across = hn::Min(hn::Mul(angle_, hn::Mul(middle, middle)), cap_);
      const MF is_known = hn::Lt(rate, hn::Zero(df));
      const VF whole = hn::IfThenZeroElse(is_known, hn::Mul(run_, across));
      const VF more =
          hn::IfThenElseZero(unknown, hn::Sub(whole, hn::IfThenElseZero(goes_on, run_area_)));
      run_area_ = whole;
      area_ = hn::Add(area_, more);
      stretch_area_ = hn::Add(stretch_area_, more);
    }
    // Where a ray ends in a voxel it stays what it was before.
    in_unknown_ = hn::Or(unknown, hn::AndNot(hn::AndNot(occupied, step.counts), in_unknown_));
    if (!hn::AllFalse(df, occupied)) {
      range_ = hn::IfThenElse(occupied, t, range_);
      x_ = hn::IfThenElse(to_i(occupied), step.at.x, x_);
      y_ = hn::IfThenElse(to_i(occupied), step.at.y, y_);
      z_ = hn::IfThenElse(to_i(occupied), step.at.z, z_);
      occupied_ = hn::Or(occupied_, occupied);
    }
    return occupied;
  }

  HWY_INLINE void store(int lane0, WalkedTile& out) const {
    hn::Store(passed_, df, out.passed + lane0);
    hn::Store(area_, df, out.area + lane0);
    hn::Store(hn::IfThenElseZero(in_unknown_, stretch_area_), df, out.stretch_area + lane0);
    hn::Store(stretch_passed_, df, out.stretch_passed + lane0);
    hn::Store(hn::IfThenElseZero(in_unknown_, hn::Sub(range_, stretch_begin_)), df,
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
  VF angle_, cap_;
  VF passed_ = hn::Set(df, 1.0F), area_ = hn::Zero(df);
  MF in_unknown_ = hn::MaskFromVec(hn::Zero(df));  // since the last step of any length
  // The run that the ray is in: where it begins, its chance and area so far.
  VF begin_ = hn::Zero(df), run_ = hn::Zero(df), run_area_ = hn::Zero(df);
  // The stretch of unknown voxels that it is in.
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

  HWY_INLINE MF step(const Step& step) {
    const MF occupied = step.is_in(BrickTable::kOccupiedVoxel);
    const MF unknown = step.is_in(BrickTable::kUnknownVoxel);
    const MF wanted = hn::Or(occupied, unknown);
    if (hn::AllFalse(df, wanted)) return occupied;
    HWY_ALIGN float begins[kWidth], ends[kWidth], rates[kWidth];
    HWY_ALIGN std::int32_t xs[kWidth], ys[kWidth], zs[kWidth];
    HWY_ALIGN std::uint32_t states[kWidth];
    hn::Store(step.t, df, begins);
    hn::Store(step.next, df, ends);
    hn::Store(step.finder.rates(step.at, unknown), df, rates);
    hn::Store(step.at.x, di, xs);
    hn::Store(step.at.y, di, ys);
    hn::Store(step.at.z, di, zs);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(du, wanted), step.place.state), du, states);
    for (int i = 0; i < kWidth; ++i) {
      if (states[i] == BrickTable::kFreeVoxel) continue;
      out_.push_back({static_cast<std::uint32_t>(lane0_ + i), states[i], xs[i], ys[i], zs[i],
                      begins[i], ends[i], rates[i]});
    }
    return occupied;
  }

 private:
  int lane0_;
  std::vector<VoxelVisit>& out_;
};

void area(const BrickTable& table, const PoseFrame& frame, const WalkLimits& limits,
          const WalkTask& task, float cap, WalkedTile& out) {
  out.occupied = 0;
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    AreaSink sink(task.solid_angle + lane0, cap);
    PacketWalk<AreaSink> walk;
    if (walk.begin(table, frame, limits, task, lane0)) {
      while (walk.step(sink)) {
      }
    }
    sink.store(lane0, out);
  }
}

void visits(const BrickTable& table, const PoseFrame& frame, const WalkLimits& limits,
            const WalkTask& task, std::vector<VoxelVisit>& out) {
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    VisitSink sink(lane0, out);
    PacketWalk<VisitSink> walk;
    if (!walk.begin(table, frame, limits, task, lane0)) continue;
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
