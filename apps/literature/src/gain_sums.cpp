// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Sums over all voxels that rays pass, one ray per lane. Compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gain_sums.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <bit>

#include "gain_sums.hpp"
#include "viewgain/support/brick_walk-inl.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Like ClassicTable::word_in_brick().
HWY_INLINE VI word_in_brick(const Voxels& v) {
  const auto part = [](VI a, std::int32_t bits) HWY_ATTR { return hn::And(a, set_i(bits)); };
  const VI cube = hn::Or(hn::Or(hn::ShiftLeft<6>(part(v.x, 4)), hn::ShiftLeft<5>(part(v.y, 4))),
                         hn::ShiftLeft<4>(part(v.z, 4)));
  const VI in_cube =
      hn::Or(hn::Or(hn::ShiftLeft<4>(part(v.x, 3)), hn::ShiftLeft<2>(part(v.y, 3))), part(v.z, 3));
  return hn::Or(cube, in_cube);
}

// Finds words. kByVoxel: steps through all voxels one by one, otherwise only through unknown ones.
template <bool kByVoxel>
class WordFinder {
 public:
  struct Place {
    VI word;  // as in ClassicTable
    VI edge;
    VI node;

    [[nodiscard]] HWY_INLINE MI is_unknown() const {
      return hn::Ne(hn::And(word, set_i(ClassicTable::kUnknown)), hn::Zero(di));
    }
    [[nodiscard]] HWY_INLINE MF is_occupied() const {
      const VI value = hn::And(word, set_i(ClassicTable::kValue));
      return to_f(hn::AndNot(is_unknown(), hn::Gt(value, set_i(kZeroCode))));
    }
  };

  explicit HWY_INLINE WordFinder(const ClassicTable& table) : table_(table) {}

  HWY_INLINE void begin(const Voxels& at) { find_nodes(at); }

  using Found = Place;
  static HWY_INLINE const Place& place(const Found& found, const Voxels&) { return found; }
  // Lane by lane: two gathers, one waiting for the other, take longer.
  HWY_INLINE Found find(const Voxels& at, VI moved) {
    if (!stay_in_nodes(moved)) find_nodes(at);
    HWY_ALIGN std::uint32_t bricks[kWidth], in_bricks[kWidth], words[kWidth];
    hn::Store(as_u(hn::Add(first_, brick_of(at))), du, bricks);
    hn::Store(as_u(word_in_brick(at)), du, in_bricks);
    const std::uint32_t* entries = table_.entries.data();
    const std::uint16_t* of_bricks = table_.words.data();
    for (std::size_t i = 0; i < kWidth; ++i) {
      // Without branches, because they would be unpredictable; index 0 is valid too.
      const std::uint32_t entry = entries[bricks[i]];
      const std::uint32_t uniform = 0U - (entry >> 31U);
      static_assert(ClassicTable::kUniform == 1U << 31U);
      const std::uint32_t own = of_bricks[(entry + in_bricks[i]) & ~uniform];
      words[i] = (entry & uniform) | (own & ~uniform);
    }
    Place place{as_i(hn::Load(du, words)), set_i(1), node_};
    if constexpr (!kByVoxel) {
      const VI shift =
          hn::And(hn::ShiftRight<ClassicTable::kEdgeShift>(place.word), set_i(ClassicTable::kEdge));
      place.edge = hn::Shl(set_i(1), hn::IfThenZeroElse(place.is_unknown(), shift));
    }
    return place;
  }

 private:
  HWY_INLINE void find_nodes(const Voxels& at) {
    node_ = node_of(table_, at);
    first_ = as_i(hn::GatherIndex(du, table_.node_entries.data(), node_));
  }

  const ClassicTable& table_;
  VI node_, first_;  // of each lane: the node and its first entry
};
using CubeFinder = WordFinder<false>;
using VoxelFinder = WordFinder<true>;

// Value of a code, below VoxelValues::kPassed, in a table of VoxelValues.
HWY_INLINE VF lookup(const std::array<float, VoxelValues::kPassed>& table, VI code) {
#if HWY_TARGET == HWY_AVX3
  const float* values = table.data();
  const __m512 low = _mm512_permutex2var_ps(_mm512_load_ps(values), code.raw,
                                            _mm512_load_ps(values + 16)),
               high = _mm512_permutex2var_ps(_mm512_load_ps(values + 32), code.raw,
                                             _mm512_load_ps(values + 48));
  return hn::IfThenElse(to_f(hn::Gt(code, set_i(31))), VF{high}, VF{low});
#else
  return hn::GatherIndex(df, table.data(), code);
#endif
}

// 2^-(absorbed + rest) in single precision, for absorbed >= 0 and a small rest.
HWY_INLINE VF left_after(VF absorbed, VF rest) {
  const VF nearest = hn::Round(absorbed);
  const VF f = hn::Add(hn::Sub(absorbed, nearest), rest);  // the difference is exact
  // exp(-f ln 2): degree 7 suffices for |f| up to 0.51.
  constexpr float kTerms[] = {-1.5252734e-5F, 1.5403530e-4F, -1.3333558e-3F, 9.6181291e-3F,
                              -5.5504109e-2F, 2.4022651e-1F, -6.9314718e-1F, 1.0F};
  VF power = hn::Set(df, kTerms[0]);
  for (int i = 1; i < 8; ++i) power = hn::MulAdd(power, f, hn::Set(df, kTerms[i]));
  const VI exponent = hn::Sub(set_i(127), hn::ConvertTo(di, hn::Min(nearest, hn::Set(df, 127.0F))));
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

HWY_INLINE MI no_lane_i() { return to_i(no_lane()); }

// Kahan summation, for sums of many numbers of similar size.
HWY_INLINE void add_to_long(VF& sum, VF& error, VF v) {
  const VF mended = hn::Sub(v, error), next = hn::Add(sum, mended);
  error = hn::Sub(hn::Sub(next, sum), mended);
  sum = next;
}

// Sums over the voxels that a packet's rays pass.
class GainSink {
 public:
  HWY_INLINE GainSink(const ClassicView& view, const float* solid_angle, DistinctVoxels& distinct)
      : view_(view), solid_angle_(solid_angle), distinct_(distinct) {}

  static constexpr bool kCountsVoxels = true;
  [[nodiscard]] static HWY_INLINE MF ends(const CubeFinder::Place& place, MF counts) {
    return hn::And(counts, place.is_occupied());
  }

  HWY_INLINE void step(const CubeFinder&, const Step<CubeFinder::Place>& step) {
    const VoxelValues& values = view_.values;
    const MI counts = to_i(step.counts), ends = to_i(step.ends);
    const MI is_unobserved = step.place.is_unknown();
    const VI code =
        hn::IfThenZeroElse(is_unobserved, hn::And(step.place.word, set_i(ClassicTable::kCode)));
    const MI unobserved = hn::And(counts, is_unobserved);
    const VI passed_code = hn::And(code, set_i(VoxelValues::kPassed - 1));
    const VI voxels = hn::IfThenElse(ends, set_i(1), step.voxels);
    const VI counted = hn::IfThenElseZero(counts, voxels);
    const VF n = hn::ConvertTo(df, counted);
    // The table has only entropies of codes below kPassed.
    VF H = lookup(view_.values.passed_entropy, passed_code);
    if (!hn::AllFalse(di, ends)) {
      H = hn::IfThenElse(to_f(ends), hn::GatherIndex(df, values.entropy.data(), code), H);
    }
    absorbed_ = hn::MulAdd(n, lookup(values.absorbed, passed_code), absorbed_);
    rest_ = hn::MulAdd(n, lookup(values.absorbed_rest, passed_code), rest_);
    const VF left = left_after(absorbed_, rest_);
    // One voxel adds P H. Several add the decrease of P times per_taken, which is accurate if each
    // absorbs much, as all known ones do.
    const VF of_many = hn::Mul(hn::Sub(left_, left), lookup(values.per_taken, passed_code));
    const VF of_one = hn::Mul(left_, H);
    const VF visible = hn::IfThenElseZero(
        to_f(counts), hn::IfThenElse(to_f(hn::Eq(voxels, set_i(1))), of_one, of_many));
    left_ = left;
    occlusion_aware_ = hn::Add(occlusion_aware_, visible);
    add_to_long(entropy_, entropy_error_, hn::Mul(n, H));
    voxels_ = hn::Add(voxels_, counted);
    if (!hn::AllFalse(di, ends)) end(ends);

    const VF of_unobserved = hn::IfThenElseZero(to_f(unobserved), visible);
    unobserved_ = hn::Add(unobserved_, of_unobserved);
    const VF stretch = hn::IfThenElseZero(to_f(unobserved), hn::Add(stretch_, visible));
    stretch_ = hn::IfThenElse(to_f(counts), stretch, stretch_);
    const MI is_free = hn::AndNot(is_unobserved, hn::AndNot(ends, counts));
    from_free_ = hn::Or(is_free, hn::AndNot(counts, from_free_));
    const MI turns = hn::And(counts, hn::Xor(in_unobserved_, is_unobserved));
    if (!hn::AllFalse(di, turns)) turn(step.t, turns, unobserved);
    if (!hn::AllFalse(di, unobserved)) pass_unobserved(step, unobserved);
  }

  // `end`: distances at which the rays end at the latest.
  HWY_INLINE void add_to(ClassicSums& sums, VF end) {
    turn(end, in_unobserved_, no_lane_i());
    sums.occlusion_aware += total(occlusion_aware_);
    sums.unobserved += total(unobserved_);
    sums.entropy += total(entropy_);
    sums.voxels += static_cast<double>(total(voxels_));
    sums.rear_side_entropy += total(rear_side_entropy_);
    sums.proximity +=
        view_.most_steps * static_cast<double>(hidden_) - static_cast<double>(total(hidden_steps_));
    sums.volume += volume_;
    sums.rear_side += rear_side_;
    sums.on_surface += on_surface_;
    sums.on_hidden += hn::CountTrue(di, is_on_hidden_);
  }

 private:
  // For rays that reach an occupied voxel.
  HWY_INLINE void end(MI occupied) {
    const MI rear = hn::And(occupied, in_unobserved_);
    rear_side_ += hn::CountTrue(di, rear);
    rear_side_entropy_ = hn::Add(rear_side_entropy_, hn::IfThenElseZero(to_f(rear), stretch_));
    on_surface_ += hn::CountTrue(di, hn::AndNot(is_on_hidden_, hn::And(occupied, from_free_)));
  }

  // For rays that enter or leave unobserved space at t. Adds the volume of the whole cone between
  // the first and the last face, because the differences per voxel would be lost in single
  // precision.
  HWY_INLINE void turn(VF at, MI lanes, MI unobserved) {
    HWY_ALIGN float ts[kWidth];
    hn::Store(at, df, ts);
    const std::uint32_t come = bits_of(to_f(unobserved));
    for (std::uint32_t bits = bits_of(to_f(lanes)); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      const auto t = static_cast<double>(ts[i]);
      const double before = t * t * t * (static_cast<double>(solid_angle_[i]) / 3);
      volume_ += (come >> static_cast<unsigned>(i) & 1U) != 0 ? -before : before;
    }
    in_unobserved_ = hn::Xor(in_unobserved_, lanes);
  }

  // Steps through unobserved space have one voxel each.
  HWY_INLINE void pass_unobserved(const Step<CubeFinder::Place>& step, MI lanes) {
    const VI steps = hn::And(hn::ShiftRight<ClassicTable::kStepsShift>(step.place.word),
                             set_i(ClassicTable::kMostSteps));
    const MI hidden = hn::And(lanes, hn::Gt(steps, hn::Zero(di)));
    is_on_hidden_ = hn::Or(is_on_hidden_, hidden);
    hidden_ += hn::CountTrue(di, hidden);
    hidden_steps_ = hn::Add(hidden_steps_, hn::IfThenElseZero(hidden, steps));
    if (!view_.is_distinct) return;
    HWY_ALIGN std::uint32_t nodes[kWidth], places[kWidth], words[kWidth];
    hn::Store(as_u(step.place.node), du, nodes);
    hn::Store(as_u(hn::Or(hn::ShiftLeft<9>(brick_of(step.at)), word_in_brick(step.at))), du,
              places);
    hn::Store(as_u(step.place.word), du, words);
    for (std::uint32_t bits = bits_of(to_f(lanes)); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      distinct_.mark(nodes[i], places[i], words[i]);
    }
  }

  const ClassicView& view_;
  const float* solid_angle_;
  DistinctVoxels& distinct_;
  VF absorbed_ = hn::Zero(df), rest_ = hn::Zero(df);      // -log2 P in two parts, as in VoxelValues
  VF left_ = hn::Set(df, 1.0F), stretch_ = hn::Zero(df);  // P; Σ P H since the last known voxel
  VF occlusion_aware_ = hn::Zero(df), unobserved_ = hn::Zero(df);
  VF entropy_ = hn::Zero(df), entropy_error_ = hn::Zero(df);
  VI voxels_ = hn::Zero(di), hidden_steps_ = hn::Zero(di);
  VF rear_side_entropy_ = hn::Zero(df);
  // State of the previous voxel, and whether the ray has met hidden voxels.
  MI in_unobserved_ = no_lane_i(), from_free_ = no_lane_i(), is_on_hidden_ = no_lane_i();
  std::uint64_t rear_side_ = 0, on_surface_ = 0, hidden_ = 0;
  double volume_ = 0;
};

// Finds where rays meet the first occupied voxel.
class SurfaceSink {
 public:
  static constexpr bool kCountsVoxels = false;
  HWY_INLINE SurfaceSink() {}

  [[nodiscard]] static HWY_INLINE MF ends(const CubeFinder::Place& place, MF counts) {
    return hn::And(counts, place.is_occupied());
  }
  HWY_INLINE void step(const CubeFinder&, const Step<CubeFinder::Place>& step) {
    range = hn::IfThenElse(step.ends, step.t, range);
    met = hn::Or(met, step.ends);
  }

  VF range = hn::Zero(df);
  MF met = no_lane();
};

// Counts the voxels behind the first occupied one.
class HiddenSink {
 public:
  static constexpr bool kCountsVoxels = false;
  explicit HWY_INLINE HiddenSink(OcclusionSteps& steps) : steps_(steps) {}

  [[nodiscard]] static HWY_INLINE MF ends(const VoxelFinder::Place&, MF) { return no_lane(); }
  HWY_INLINE void step(const VoxelFinder&, const Step<VoxelFinder::Place>& step) {
    const MI counts = to_i(step.counts);
    count_ = hn::Add(count_, hn::IfThenElseZero(hn::And(counts, is_behind_), set_i(1)));
    is_behind_ = hn::Or(is_behind_, to_i(hn::And(step.counts, step.place.is_occupied())));
    const MI hidden =
        hn::And(hn::And(counts, step.place.is_unknown()), hn::Gt(count_, hn::Zero(di)));
    HWY_ALIGN std::int32_t xs[kWidth], ys[kWidth], zs[kWidth], counted[kWidth];
    hn::Store(step.at.x, di, xs);
    hn::Store(step.at.y, di, ys);
    hn::Store(step.at.z, di, zs);
    hn::Store(count_, di, counted);
    for (std::uint32_t bits = bits_of(to_f(hidden)); bits != 0; bits &= bits - 1) {
      const int i = std::countr_zero(bits);
      steps_.mark(xs[i], ys[i], zs[i], static_cast<std::uint8_t>(counted[i]));
    }
  }

 private:
  OcclusionSteps& steps_;
  VI count_ = hn::Zero(di);
  MI is_behind_ = no_lane_i();
};

template <typename Finder, typename Sink>
void walk(const ClassicTable& table, const WalkLimits& limits, const WalkTask& task, int lane0,
          Sink& sink) {
  PacketWalk<Finder, Sink> packet{Finder(table)};
  if (!packet.begin(table, limits, task, lane0)) return;
  while (packet.step(sink)) {
  }
}

void add(const ClassicView& view, const WalkLimits& limits, const WalkTask& task, ClassicSums& sums,
         DistinctVoxels& distinct) {
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    PacketWalk<CubeFinder, GainSink> packet{CubeFinder(view.table)};
    GainSink sink(view, task.solid_angle + lane0, distinct);
    if (!packet.begin(view.table, limits, task, lane0)) continue;
    while (packet.step(sink)) {
    }
    sink.add_to(sums, packet.end());
  }
}

void mark_hidden(const ClassicTable& table, const WalkLimits& limits, float depth, WalkTask& task,
                 OcclusionSteps& steps) {
  std::uint32_t met = 0;
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    SurfaceSink sink;
    walk<CubeFinder>(table, limits, task, lane0, sink);
    met |= bits_of(sink.met) << static_cast<unsigned>(lane0);
    hn::Store(sink.range, df, task.near + lane0);
    hn::Store(hn::Add(sink.range, hn::Set(df, depth)), df, task.far + lane0);
  }
  task.lanes = met;
  for (int lane0 = 0; lane0 < kTileRays; lane0 += kWidth) {
    HiddenSink sink(steps);
    walk<VoxelFinder>(table, limits, task, lane0, sink);
  }
}

}  // namespace

const ClassicKernels& kernels_of_target() {
  static const ClassicKernels kernels{add, mark_hidden};
  return kernels;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

const ClassicKernels& classic_kernels(Isa isa) { return VIEWGAIN_OF_ISA(isa, kernels_of_target)(); }

}  // namespace viewgain::detail
#endif
