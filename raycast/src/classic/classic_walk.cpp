// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What rays meet on their way through all voxels, a ray a lane, in double precision. Compiled once
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

// VoxelValues::Run, one a lane.
struct Runs {
  VD visible, passed, entropy;
};

HWY_INLINE Runs runs_at(const VoxelValues& values, VL index) {
#if HWY_TARGET == HWY_AVX3
  // Loads of whole runs, turned: cheaper than three gathers.
  HWY_ALIGN std::int64_t at[kLanes];
  hn::Store(index, dl, at);
  const VoxelValues::Run* runs = values.runs.data();
  const auto pair = [&](std::size_t i) HWY_ATTR {
    const __m256d low = _mm256_loadu_pd(&runs[at[i]].visible),
                  high = _mm256_loadu_pd(&runs[at[i + 4]].visible);
    return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
  };
  const __m512d a = pair(0), b = pair(1), c = pair(2), d = pair(3);
  const __m512d even_ab = _mm512_unpacklo_pd(a, b), even_cd = _mm512_unpacklo_pd(c, d);
  const __m512d odd_ab = _mm512_unpackhi_pd(a, b), odd_cd = _mm512_unpackhi_pd(c, d);
  const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  return {VD{_mm512_permutex2var_pd(even_ab, first, even_cd)},
          VD{_mm512_permutex2var_pd(odd_ab, first, odd_cd)},
          VD{_mm512_permutex2var_pd(even_ab, second, even_cd)}};
#else
  const double* doubles = &values.runs.data()->visible;
  const VL at = hn::ShiftLeft<2>(index);
  return {hn::GatherIndex(dd, doubles, at), hn::GatherIndex(dd, doubles + 1, at),
          hn::GatherIndex(dd, doubles + 2, at)};
#endif
}

// Sums what a packet's rays meet.
class GainSink {
 public:
  HWY_INLINE GainSink(const ClassicView& view, const float* solid_angle)
      : view_(view), third_of_angle_(angles(solid_angle)) {}

  // Lanes that end in an occupied voxel.
  HWY_INLINE ML step(const CubeStep& step, DistinctVoxels& distinct) {
    const ML is_unobserved =
        hn::Ne(hn::And(step.word, whole(ClassicTable::kUnknown)), hn::Zero(dl));
    const VL code =
        hn::IfThenZeroElse(is_unobserved, hn::And(step.word, whole(ClassicTable::kCode)));
    const ML counts = step.counts;
    const ML ends = hn::And(counts, hn::Gt(code, whole(kLastFree)));
    const ML unobserved = hn::And(counts, is_unobserved);
    const ML is_free =
        hn::And(hn::Lt(code, whole(view_.values.free_end)), hn::Gt(code, hn::Zero(dl)));
    const ML is_occupied = hn::Gt(code, whole(view_.values.occupied_begin - 1));
    const ML unknown = hn::AndNot(is_free, hn::AndNot(is_occupied, counts));

    const VD n = hn::IfThenElse(to_d(ends), real(1.0), step.voxels);
    const Runs runs =
        runs_at(view_.values, hn::Or(hn::ShiftLeft<VoxelValues::kRowBits>(code), integer_of(n)));
    const VD visible = hn::IfThenElseZero(to_d(counts), hn::Mul(passed_, runs.visible));
    occlusion_aware_ = hn::Add(occlusion_aware_, visible);
    const VD of_unknown = hn::IfThenElseZero(to_d(unknown), visible);
    unobserved_ = hn::Add(unobserved_, of_unknown);
    entropy_ = hn::Add(entropy_, hn::IfThenElseZero(to_d(counts), runs.entropy));
    voxels_ = hn::Add(voxels_, hn::IfThenElseZero(to_d(counts), n));
    if (!hn::AllFalse(dl, ends)) end(hn::And(ends, is_occupied), visible);

    passed_ = hn::IfThenElse(to_d(counts), hn::Mul(passed_, runs.passed), passed_);
    const VD stretch = hn::IfThenElseZero(to_d(unknown), hn::Add(stretch_, visible));
    stretch_ = hn::IfThenElse(to_d(counts), stretch, stretch_);
    from_unknown_ = hn::Or(unknown, hn::AndNot(counts, from_unknown_));
    from_free_ = hn::Or(hn::And(counts, is_free), hn::AndNot(counts, from_free_));
    if (!hn::AllFalse(dl, unobserved)) pass_unobserved(step, unobserved, n, distinct);
    return ends;
  }

  HWY_INLINE void add_to(ClassicSums& sums) const {
    sums.occlusion_aware += total(occlusion_aware_);
    sums.unobserved += total(unobserved_);
    sums.entropy += total(view_.is_shipped ? ended_entropy_ : entropy_);
    sums.voxels += total(view_.is_shipped ? ended_voxels_ : voxels_);
    sums.rear_side_entropy += total(rear_side_entropy_);
    sums.proximity += total(proximity_);
    sums.volume += total(hn::Mul(volume_, third_of_angle_));
    sums.rear_side += rear_side_;
    sums.on_surface += on_surface_;
    sums.on_hidden += hn::CountTrue(dl, is_on_hidden_);
  }

 private:
  // The code of log-odds 0.
  static constexpr std::int64_t kLastFree = 41;

  static HWY_INLINE VD angles(const float* solid_angle) {
    HWY_ALIGN double thirds[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i) thirds[i] = static_cast<double>(solid_angle[i]) / 3;
    return hn::Load(dd, thirds);
  }
  static HWY_INLINE double total(VD v) { return hn::GetLane(hn::SumOfLanes(dd, v)); }

  // Rays that come to what counts as occupied; `visible` is P H of it.
  HWY_INLINE void end(ML occupied, VD visible) {
    const ML rear = hn::And(occupied, from_unknown_);
    rear_side_ += hn::CountTrue(dl, rear);
    rear_side_entropy_ = hn::Add(rear_side_entropy_, hn::IfThenElseZero(to_d(rear), stretch_));
    on_surface_ += hn::CountTrue(dl, hn::AndNot(is_on_hidden_, hn::And(occupied, from_free_)));
    if (!view_.is_shipped) return;
    const MD lanes = to_d(occupied);
    rear_side_entropy_ = hn::Add(rear_side_entropy_, hn::IfThenElseZero(lanes, visible));
    ended_entropy_ = hn::IfThenElse(lanes, entropy_, ended_entropy_);
    ended_voxels_ = hn::IfThenElse(lanes, voxels_, ended_voxels_);
  }

  HWY_INLINE void pass_unobserved(const CubeStep& step, ML lanes, VD n, DistinctVoxels& distinct) {
    const auto cube = [](VD t) HWY_ATTR { return hn::Mul(t, hn::Mul(t, t)); };
    volume_ =
        hn::Add(volume_, hn::IfThenElseZero(to_d(lanes), hn::Sub(cube(step.next), cube(step.t))));
    const VL steps = hn::And(hn::ShiftRight<ClassicTable::kStepsShift>(step.word),
                             whole(ClassicTable::kMostSteps));
    const ML hidden = hn::And(lanes, hn::Gt(steps, hn::Zero(dl)));
    is_on_hidden_ = hn::Or(is_on_hidden_, hidden);
    const VD nearness = hn::Mul(n, hn::Sub(real(view_.most_steps), real_of(steps)));
    proximity_ = hn::Add(proximity_, hn::IfThenElseZero(to_d(hidden), nearness));
    if (!view_.is_distinct) return;
    HWY_ALIGN std::int64_t xs[kLanes], ys[kLanes], zs[kLanes], words[kLanes];
    hn::Store(integer_of(step.at.x), dl, xs);
    hn::Store(integer_of(step.at.y), dl, ys);
    hn::Store(integer_of(step.at.z), dl, zs);
    hn::Store(step.word, dl, words);
    for (unsigned bits = bits_of(lanes); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      distinct.mark(static_cast<std::int32_t>(xs[i]), static_cast<std::int32_t>(ys[i]),
                    static_cast<std::int32_t>(zs[i]), static_cast<std::uint32_t>(words[i]));
    }
  }

  const ClassicView& view_;
  VD third_of_angle_;
  VD passed_ = real(1.0), stretch_ = hn::Zero(dd);
  VD occlusion_aware_ = hn::Zero(dd), unobserved_ = hn::Zero(dd);
  VD entropy_ = hn::Zero(dd), voxels_ = hn::Zero(dd);
  VD ended_entropy_ = hn::Zero(dd), ended_voxels_ = hn::Zero(dd);
  VD rear_side_entropy_ = hn::Zero(dd), proximity_ = hn::Zero(dd), volume_ = hn::Zero(dd);
  // What the voxel before counted as, and whether the ray has come to what surfaces hide.
  ML from_unknown_ = no_lane(), from_free_ = no_lane(), is_on_hidden_ = no_lane();
  std::uint64_t rear_side_ = 0, on_surface_ = 0;
};

void add_tile(const ClassicView& view, const ClassicTile& tile, ClassicSums& sums,
              DistinctVoxels& distinct) {
  // Two packets take turns, so that one need not wait for what the other gathers.
  static_assert(kTileRays % (2 * kLanes) == 0);
  for (std::size_t lane0 = 0; lane0 < kTileRays; lane0 += 2 * kLanes) {
    CubeWalk one, other;
    GainSink of_one(view, tile.solid_angle + lane0),
        of_other(view, tile.solid_angle + lane0 + kLanes);
    bool one_goes = one.begin(view, tile, lane0),
         other_goes = other.begin(view, tile, lane0 + kLanes);
    while (one_goes || other_goes) {
      if (one_goes) one_goes = one.step(of_one, distinct);
      if (other_goes) other_goes = other.step(of_other, distinct);
    }
    of_one.add_to(sums);
    of_other.add_to(sums);
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
