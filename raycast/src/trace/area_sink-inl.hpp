// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The Sink of walks through unknown space that sums the area of new surface to be expected.
// Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_AREA_SINK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_AREA_SINK_INL_HPP
#undef VIEWGAIN_AREA_SINK_INL_HPP
#else
#define VIEWGAIN_AREA_SINK_INL_HPP
#endif

#include <hwy/highway.h>

#include "hazard_finder-inl.hpp"
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
  using Finder = AreaFinder<kMissed>;
  static constexpr bool kCountsVoxels = false;

  [[nodiscard]] static HWY_INLINE MF ends(const typename Finder::Place& place, MF counts) {
    return Finder::is_in(place, BrickTable::kOccupiedVoxel, counts);
  }

  HWY_INLINE AreaSink(const float* solid_angle, const PixelWorth& worth, const float* missed)
      : angle_(hn::Mul(hn::LoadU(df, solid_angle), hn::Set(df, worth.scale))),
        cap_(hn::Set(df, worth.cap * worth.scale)),
        one_and_s0_(hn::Set(df, 1 + worth.s0)),
        s1_(hn::Set(df, worth.s1)),
        s2_(hn::Set(df, worth.s2)),
        at_(hn::Set(df, worth.at)),
        missed_(missed) {}

  HWY_INLINE void step(const Finder& finder, const Step<typename Finder::Place>& step) {
    const MF unknown = Finder::is_in(step.place, BrickTable::kUnknownVoxel, step.counts);
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

      const VF rate = step.place.rate;
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
      const VF length = hn::Sub(next, begin_);
      // The mean of t² over the run.
      const VF squared = hn::Add(hn::Mul(middle, middle),
                                 hn::Mul(hn::Set(df, 1.0F / 12.0F), hn::Mul(length, length)));
      VF across = hn::Div(hn::Min(hn::Mul(angle_, squared), cap_), misses(middle));
      if constexpr (kMissed)
        across = hn::Mul(across, missed_at(finder.places(step.place, step.at, unknown)));
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
  [[nodiscard]] HWY_INLINE VF missed_at(VI places) const {
    return hn::GatherIndex(df, missed_, places);
  }
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

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
