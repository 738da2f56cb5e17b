// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What rays meet on their way through all voxels, a ray a lane. Compiled once
// for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "classic/classic_walk.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include "classic_walk.hpp"
#include "cube_walk-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// What a code has in a table of VoxelValues; codes are below VoxelValues::kPassed.
HWY_INLINE VF lookup(const std::array<float, VoxelValues::kPassed>& table, VI code) {
#if HWY_TARGET == HWY_AVX3
  const float* values = table.data();
  const __m512 low = _mm512_permutex2var_ps(_mm512_load_ps(values), code.raw,
                                            _mm512_load_ps(values + 16)),
               high = _mm512_permutex2var_ps(_mm512_load_ps(values + 32), code.raw,
                                             _mm512_load_ps(values + 48));
  return hn::IfThenElse(to_f(hn::Gt(code, whole(31))), VF{high}, VF{low});
#else
  return hn::GatherIndex(df, table.data(), code);
#endif
}

// 2^-(whole + rest), whole above 0 and rest small, to single precision.
HWY_INLINE VF left_after(VF absorbed, VF rest) {
  const VF nearest = hn::Round(absorbed);
  const VF f = hn::Add(hn::Sub(absorbed, nearest), rest);  // the difference is exact
  // exp(-f ln 2): seven terms are enough for |f| to 0.51.
  constexpr float kTerms[] = {-1.5252734e-5F, 1.5403530e-4F, -1.3333558e-3F, 9.6181291e-3F,
                              -5.5504109e-2F, 2.4022651e-1F, -6.9314718e-1F, 1.0F};
  VF power = real(kTerms[0]);
  for (int i = 1; i < 8; ++i) power = hn::MulAdd(power, f, real(kTerms[i]));
  const VI exponent = hn::Sub(whole(127), hn::ConvertTo(di, hn::Min(nearest, real(127.0F))));
  return hn::Mul(power, hn::BitCast(df, hn::ShiftLeft<23>(exponent)));
}

HWY_INLINE double total(VF v) {
  HWY_ALIGN float lanes[kWidth];
  hn::Store(v, df, lanes);
  double sum = 0;
  for (const float lane : lanes) sum += static_cast<double>(lane);
  return sum;
}
HWY_INLINE std::int64_t total(VI v) {
  HWY_ALIGN std::int32_t lanes[kWidth];
  hn::Store(v, di, lanes);
  std::int64_t sum = 0;
  for (const std::int32_t lane : lanes) sum += lane;
  return sum;
}

// Adds to a sum of many numbers of one size, with what rounding took of it (Kahan's).
HWY_INLINE void add_to_long(VF& sum, VF& error, VF v) {
  const VF mended = hn::Sub(v, error), next = hn::Add(sum, mended);
  error = hn::Sub(hn::Sub(next, sum), mended);
  sum = next;
}

// Sums what a packet's rays meet.
class GainSink {
 public:
  HWY_INLINE GainSink(const ClassicView& view, const float* solid_angle, DistinctVoxels& distinct)
      : view_(view), solid_angle_(solid_angle), distinct_(distinct) {}

  HWY_INLINE void step(const CubeStep& step, const ExactRays& rays) {
    const VoxelValues& values = view_.values;
    const MI counts = step.counts;
    const MI is_unobserved = step.is_unknown, ends = step.ends;
    const VI code =
        hn::IfThenZeroElse(is_unobserved, hn::And(step.word, whole(ClassicTable::kCode)));
    const MI unobserved = hn::And(counts, is_unobserved);
    const MI is_free = hn::AndNot(is_unobserved, hn::Lt(code, whole(values.free_end)));
    const MI is_occupied = hn::Gt(code, whole(values.occupied_begin - 1));
    const MI unknown = hn::AndNot(is_free, hn::AndNot(is_occupied, counts));

    const VI passed_code = hn::And(code, whole(VoxelValues::kPassed - 1));
    const VI voxels = hn::IfThenElse(ends, whole(1), step.voxels);
    const VI counted = hn::IfThenElseZero(counts, voxels);
    const VF n = hn::ConvertTo(df, counted);
    // Of the entropies only those below kPassed.
    VF H = lookup(view_.values.passed_entropy, passed_code);
    if (!hn::AllFalse(di, ends)) {
      H = hn::IfThenElse(to_f(ends), hn::GatherIndex(df, values.entropy.data(), code), H);
    }
    absorbed_ = hn::MulAdd(n, lookup(values.absorbed, passed_code), absorbed_);
    rest_ = hn::MulAdd(n, lookup(values.absorbed_rest, passed_code), rest_);
    const VF left = left_after(absorbed_, rest_);
    // One voxel has P H; several together what they take, which rounding leaves alone if voxels
    // absorb much as all known ones do.
    const VF of_many = hn::Mul(hn::Sub(left_, left), lookup(values.per_taken, passed_code));
    const VF of_one = hn::Mul(left_, H);
    const VF visible = hn::IfThenElseZero(
        to_f(counts), hn::IfThenElse(to_f(hn::Eq(voxels, whole(1))), of_one, of_many));
    left_ = left;
    occlusion_aware_ = hn::Add(occlusion_aware_, visible);
    add_to_long(entropy_, entropy_error_, hn::Mul(n, H));
    voxels_ = hn::Add(voxels_, counted);
    if (!hn::AllFalse(di, ends)) end(hn::And(ends, is_occupied), visible);

    const VF of_unknown = hn::IfThenElseZero(to_f(unknown), visible);
    unobserved_ = hn::Add(unobserved_, of_unknown);
    const VF stretch = hn::IfThenElseZero(to_f(unknown), hn::Add(stretch_, visible));
    stretch_ = hn::IfThenElse(to_f(counts), stretch, stretch_);
    from_unknown_ = hn::Or(unknown, hn::AndNot(counts, from_unknown_));
    from_free_ = hn::Or(hn::And(counts, is_free), hn::AndNot(counts, from_free_));
    const MI turns = hn::And(counts, hn::Xor(in_unobserved_, is_unobserved));
    if (!hn::AllFalse(di, turns)) turn(step.at, turns, unobserved, rays);
    if (!hn::AllFalse(di, unobserved)) pass_unobserved(step, unobserved);
  }

  HWY_INLINE void add_to(ClassicSums& sums, const CubeWalk& walk) {
    for (unsigned bits = bits_of(in_unobserved_); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      volume_ += cone(i, walk.rays().end_at[i]);
    }
    sums.occlusion_aware += total(occlusion_aware_);
    sums.unobserved += total(unobserved_);
    sums.entropy += total(view_.is_shipped ? ended_entropy_ : entropy_);
    sums.voxels += static_cast<double>(total(view_.is_shipped ? ended_voxels_ : voxels_));
    sums.rear_side_entropy += total(rear_side_entropy_);
    sums.proximity +=
        view_.most_steps * static_cast<double>(hidden_) - static_cast<double>(total(hidden_steps_));
    sums.volume += volume_;
    sums.rear_side += rear_side_;
    sums.on_surface += on_surface_;
    sums.on_hidden += hn::CountTrue(di, is_on_hidden_);
  }

 private:
  // A ray's cone from its origin to t.
  [[nodiscard]] HWY_INLINE double cone(int lane, double t) const {
    return t * t * t * (static_cast<double>(solid_angle_[lane]) / 3);
  }

  // Rays that come to what counts as occupied; `visible` is P H of it.
  HWY_INLINE void end(MI occupied, VF visible) {
    const MI rear = hn::And(occupied, from_unknown_);
    rear_side_ += hn::CountTrue(di, rear);
    rear_side_entropy_ = hn::Add(rear_side_entropy_, hn::IfThenElseZero(to_f(rear), stretch_));
    on_surface_ += hn::CountTrue(di, hn::AndNot(is_on_hidden_, hn::And(occupied, from_free_)));
    if (!view_.is_shipped) return;
    rear_side_entropy_ = hn::Add(rear_side_entropy_, hn::IfThenElseZero(to_f(occupied), visible));
    ended_entropy_ = hn::IfThenElse(to_f(occupied), entropy_, ended_entropy_);
    ended_voxels_ = hn::IfThenElse(occupied, voxels_, ended_voxels_);
  }

  // Rays that come into unobserved space or leave it: the cones of the voxels between differ by
  // less than single precision tells, but only the first face and the last count.
  HWY_INLINE void turn(const Voxels& at, MI lanes, MI unobserved, const ExactRays& rays) {
    HWY_ALIGN std::int32_t x[kWidth], y[kWidth], z[kWidth];
    CubeWalk::store(at, x, y, z);
    const unsigned come = bits_of(unobserved);
    for (unsigned bits = bits_of(lanes); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      const double before = cone(i, rays.enters(i, {x[i], y[i], z[i]}));
      volume_ += (come >> static_cast<unsigned>(i) & 1U) != 0 ? -before : before;
    }
    in_unobserved_ = hn::Xor(in_unobserved_, lanes);
  }

  // Unobserved voxels are passed one by one.
  HWY_INLINE void pass_unobserved(const CubeStep& step, MI lanes) {
    const VI steps = hn::And(hn::ShiftRight<ClassicTable::kStepsShift>(step.word),
                             whole(ClassicTable::kMostSteps));
    const MI hidden = hn::And(lanes, hn::Gt(steps, hn::Zero(di)));
    is_on_hidden_ = hn::Or(is_on_hidden_, hidden);
    hidden_ += hn::CountTrue(di, hidden);
    hidden_steps_ = hn::Add(hidden_steps_, hn::IfThenElseZero(hidden, steps));
    if (!view_.is_distinct) return;
    HWY_ALIGN std::uint32_t nodes[kWidth], places[kWidth], words[kWidth];
    hn::Store(hn::BitCast(du, step.node), du, nodes);
    hn::Store(hn::BitCast(du, step.place()), du, places);
    hn::Store(hn::BitCast(du, step.word), du, words);
    for (unsigned bits = bits_of(lanes); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      distinct_.mark(nodes[i], places[i], words[i]);
    }
  }

  const ClassicView& view_;
  const float* solid_angle_;
  DistinctVoxels& distinct_;
  VF absorbed_ = hn::Zero(df), rest_ = hn::Zero(df);  // -log2 of P, as VoxelValues has it
  VF left_ = real(1.0F), stretch_ = hn::Zero(df);     // P, and Σ P H since what was not unknown
  VF occlusion_aware_ = hn::Zero(df), unobserved_ = hn::Zero(df);
  VF entropy_ = hn::Zero(df), entropy_error_ = hn::Zero(df);
  VI voxels_ = hn::Zero(di), ended_voxels_ = hn::Zero(di), hidden_steps_ = hn::Zero(di);
  VF ended_entropy_ = hn::Zero(df), rear_side_entropy_ = hn::Zero(df);
  // What the voxel before counted as, and whether the ray has come to what surfaces hide.
  MI from_unknown_ = no_lane(), from_free_ = no_lane(), is_on_hidden_ = no_lane();
  MI in_unobserved_ = no_lane();
  std::uint64_t rear_side_ = 0, on_surface_ = 0, hidden_ = 0;
  double volume_ = 0;
};

void add_tile(const ClassicView& view, const ClassicTile& tile, ClassicSums& sums,
              DistinctVoxels& distinct) {
  static_assert(kTileRays % kWidth == 0);
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    CubeWalk walk;
    GainSink sink(view, tile.solid_angle + lane0, distinct);
    if (!walk.begin(view, tile, lane0)) continue;
    while (walk.step(sink)) {
    }
    sink.add_to(sums, walk);
  }
}

}  // namespace

AddTile classic_walk_of_target() { return add_tile; }

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

AddTile classic_walk(Isa isa) {
  switch (isa) {
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::classic_walk_of_target();
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::classic_walk_of_target();
#endif
    default:
      return HWY_STATIC_DISPATCH(classic_walk_of_target)();
  }
}

}  // namespace viewgain::detail
#endif
