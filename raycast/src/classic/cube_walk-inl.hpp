// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Takes packets of rays through a ClassicTable in order, cube by cube, a ray a lane: what
// OrderedRay does, by the same voxels. Steps are made in single precision with a bound on its
// error. Voxels are whole numbers, so that a step that is nearer to a tie than the bound can be
// made again in double precision by itself. Included once for each instruction set; Highway flips
// the toggle.
#if defined(VIEWGAIN_CUBE_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_CUBE_WALK_INL_HPP
#undef VIEWGAIN_CUBE_WALK_INL_HPP
#else
#define VIEWGAIN_CUBE_WALK_INL_HPP
#endif

#include <hwy/highway.h>

#include <bit>
#include <cmath>

#include "classic_walk.hpp"
#include "exact_ray.hpp"
#include "trace/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE VF real(float v) { return hn::Set(df, v); }
HWY_INLINE VI whole(std::int32_t v) { return hn::Set(di, v); }
HWY_INLINE MF to_f(MI m) { return hn::RebindMask(df, m); }
HWY_INLINE MI to_i(MF m) { return hn::RebindMask(di, m); }
HWY_INLINE MI no_lane() { return hn::Lt(hn::Zero(di), hn::Zero(di)); }

HWY_INLINE unsigned bits_of(MI mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(di, mask, bits);
  return (bits[0] | static_cast<unsigned>(bits[1]) << 8U) & ((1U << kWidth) - 1U);
}

HWY_INLINE VI gather(const std::vector<std::uint32_t>& table, VI index) {
  return hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(table.data()), index);
}

// Four bytes that end in the word; indices are above 0.
HWY_INLINE VI gather(const std::vector<std::uint16_t>& table, VI index) {
#if HWY_TARGET == HWY_AVX3
  const VI four{_mm512_i32gather_epi32(index.raw, table.data() - 1, 2)};
  return hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, four)));
#elif HWY_TARGET == HWY_AVX2
  const VI four{
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(table.data() - 1), index.raw, 2)};
  return hn::BitCast(di, hn::ShiftRight<16>(hn::BitCast(du, four)));
#else
  HWY_ALIGN std::int32_t lanes[kWidth];
  hn::Store(index, di, lanes);
  for (std::int32_t& lane : lanes) lane = table[static_cast<std::size_t>(lane)];
  return hn::Load(di, lanes);
#endif
}

// Truncation that needs no care of numbers that no integer holds.
HWY_INLINE VI truncated(VF v) {
#if HWY_TARGET == HWY_AVX3
  return VI{_mm512_cvttps_epi32(v.raw)};
#elif HWY_TARGET == HWY_AVX2
  return VI{_mm256_cvttps_epi32(v.raw)};
#else
  return hn::ConvertTo(di, v);
#endif
}

// Whole numbers, the voxels that rays are in.
struct Voxels {
  VI x, y, z;
};

// The entry of their brick in its node.
HWY_INLINE VI brick_of(const Voxels& v) {
  const VI mask = whole(0x78);
  return hn::Or(hn::Or(hn::ShiftLeft<5>(hn::And(v.x, mask)), hn::ShiftLeft<1>(hn::And(v.y, mask))),
                hn::ShiftRight<3>(hn::And(v.z, mask)));
}

// As ClassicTable::word_in_brick().
HWY_INLINE VI in_brick(const Voxels& v) {
  const auto part = [](VI a, std::int32_t bits) HWY_ATTR { return hn::And(a, whole(bits)); };
  const VI cube = hn::Or(hn::Or(hn::ShiftLeft<6>(part(v.x, 4)), hn::ShiftLeft<5>(part(v.y, 4))),
                         hn::ShiftLeft<4>(part(v.z, 4)));
  const VI in_cube =
      hn::Or(hn::Or(hn::ShiftLeft<4>(part(v.x, 3)), hn::ShiftLeft<2>(part(v.y, 3))), part(v.z, 3));
  return hn::Or(cube, in_cube);
}

// What a step leads through: voxels that are the same.
struct CubeStep {
  VI word;    // as ClassicTable's
  Voxels at;  // the first
  VI node;
  VI voxels;      // how many
  MI counts;      // lanes for which it has a length
  MI is_unknown;  // no reading told of them
  MI ends;        // lanes of `counts` that end there, in an occupied voxel

  // The number of the first in its node, for DistinctVoxels.
  [[nodiscard]] HWY_INLINE VI place() const {
    return hn::Or(hn::ShiftLeft<9>(brick_of(at)), in_brick(at));
  }
};

// One axis of a packet's rays. The origin is in two parts, of which the first is whole.
struct Axis {
  std::int32_t origin;
  float rest;
  VF direction, inverse;
  VI forward, over;  // all bits and 1 where the ray runs towards larger voxels, else 0 and -1
  VI stop;           // the first voxel beyond the workspace
};

class CubeWalk {
 public:
  // False if no ray goes anywhere.
  HWY_INLINE bool begin(const ClassicView& view, const ClassicTile& tile, int lane0) {
    table_ = &view.table;
    rays_.begin(view, tile, lane0, kWidth);
    if (rays_.active == 0) return false;
    x_ = axis_of(view, tile.dx + lane0, 0);
    y_ = axis_of(view, tile.dy + lane0, 1);
    z_ = axis_of(view, tile.dz + lane0, 2);
    t_ = hn::Load(df, rays_.near);
    end_ = hn::Load(df, rays_.far);
    near_error_ = hn::Load(df, rays_.error);
    at_ = {hn::Load(di, rays_.voxel[0]), hn::Load(di, rays_.voxel[1]),
           hn::Load(di, rays_.voxel[2])};
    active_ = lanes_of(rays_.active);
    find_nodes(at_);
    fetch_words();
    return true;
  }

  // Calls sink.step(CubeStep, rays). False if no ray goes on.
  template <typename Sink>
  HWY_INLINE bool step(Sink& sink) {
    const VI word = hn::BitCast(di, hn::Load(du, words_));
    const MI is_unknown = hn::Ne(hn::And(word, whole(ClassicTable::kUnknown)), hn::Zero(di));
    const VI shift =
        hn::And(hn::ShiftRight<ClassicTable::kEdgeShift>(word), whole(ClassicTable::kEdge));
    // Unknown voxels are met one by one.
    const VI edge = hn::Shl(whole(1), hn::IfThenZeroElse(is_unknown, shift));
    const Along x = along(x_, at_.x, edge), y = along(y_, at_.y, edge), z = along(z_, at_.z, edge);
    const VF exit = hn::Min(x.leaves, hn::Min(y.leaves, z.leaves));
    const VF next = hn::Min(exit, end_);
    const VF error = hn::MulAdd(next, real(kStepError), near_error_);
    const VF within = hn::Add(exit, error);
    const MF leaves = hn::Le(hn::Sub(exit, error), end_);
    const VI top = hn::Sub(edge, whole(1));
    VI voxels = whole(1);
    // Two planes are met together, or the step has hardly a length.
    const MF near_x = hn::Le(x.leaves, within), near_y = hn::Le(y.leaves, within),
             near_z = hn::Le(z.leaves, within);
    MF doubt = hn::Or(hn::And(near_x, near_y), hn::And(near_z, hn::Or(near_x, near_y)));
    doubt = hn::Or(doubt, hn::Le(hn::Sub(next, t_), error));
    MF between = hn::Lt(hn::Zero(df), hn::Zero(df));
    MI stops = no_lane();
    const auto advance = [&](const Axis& axis, VI v, const Along& a) HWY_ATTR {
      const MF crosses = hn::And(leaves, hn::Le(a.leaves, exit));
      const VI far_side = hn::Add(a.low, hn::And(axis.forward, top));
      const VF place = hn::Add(hn::Mul(axis.direction, next), real(axis.rest));
      const VF floor = hn::Floor(place), above = hn::Sub(place, floor);
      between =
          hn::Or(between, hn::AndNot(crosses, hn::Or(hn::Le(above, error),
                                                     hn::Ge(above, hn::Sub(real(1.0F), error)))));
      const VI inside = hn::Min(hn::Max(hn::Add(truncated(floor), whole(axis.origin)), a.low),
                                hn::Add(a.low, top));
      const VI last = hn::IfThenElse(to_i(crosses), far_side, inside);
      voxels = hn::Add(voxels, hn::Abs(hn::Sub(last, v)));
      const VI beyond = hn::Add(last, hn::IfThenElseZero(to_i(crosses), axis.over));
      stops = hn::Or(stops, hn::Eq(beyond, axis.stop));
      return beyond;
    };
    Voxels beyond{advance(x_, at_.x, x), advance(y_, at_.y, y), advance(z_, at_.z, z)};
    // Where the point is on faces between voxels only matters in larger cubes.
    doubt = hn::Or(doubt, hn::And(between, to_f(hn::Gt(top, hn::Zero(di)))));
    doubt = hn::Or(doubt, hn::AndNot(to_f(stops), hn::Le(hn::Abs(hn::Sub(exit, end_)), error)));
    MI counts = active_, goes_on = hn::AndNot(stops, to_i(hn::Lt(exit, end_)));
    const unsigned doubtful = bits_of(hn::And(active_, to_i(doubt)));
    if (HWY_UNLIKELY(doubtful != 0)) resolve(doubtful, edge, voxels, beyond, counts, goes_on);
    const MI is_occupied =
        hn::Gt(hn::And(word, whole(ClassicTable::kValue)), whole(VoxelValues::kLastFree));
    const MI ends = hn::And(counts, hn::AndNot(is_unknown, is_occupied));
    const CubeStep passed{word, at_, node_, voxels, counts, is_unknown, ends};
    active_ = hn::AndNot(ends, hn::And(active_, goes_on));
    const bool any = !hn::AllFalse(di, active_);
    if (any) {
      t_ = next;
      // What is gathered here is waited for while the sink is busy.
      move_to(beyond);
      fetch_words();
    }
    sink.step(passed, rays_);
    return any;
  }

  [[nodiscard]] HWY_INLINE const ExactRays& rays() const { return rays_; }

 private:
  // Relative error of a distance along the ray, with a good margin: the plane less the origin, the
  // reciprocal and their product are rounded, and the point's place is found from it.
  static constexpr float kStepError = 6e-7F;

  // How a cube is left along an axis: its lowest voxel, and where on the ray.
  struct Along {
    VI low;
    VF leaves;
  };

  static HWY_INLINE MI lanes_of(unsigned bits) {
    const VI lane = hn::Shl(whole(1), hn::Iota(di, 0));
    return hn::TestBit(whole(static_cast<std::int32_t>(bits)), lane);
  }

  HWY_INLINE Axis axis_of(const ClassicView& view, const double* direction, std::size_t a) const {
    HWY_ALIGN float d[kWidth];
    for (int i = 0; i < kWidth; ++i) d[i] = static_cast<float>(direction[i]);
    const VF inverse = hn::Load(df, rays_.inverse[a]);
    const double origin = std::floor(view.origin[a]);
    const MI is_forward = to_i(hn::Lt(hn::Zero(df), inverse));
    const std::int32_t low = table_->offset[a], high = low + table_->size[a];
    return {static_cast<std::int32_t>(origin),
            static_cast<float>(view.origin[a] - origin),
            hn::Load(df, d),
            inverse,
            hn::IfThenElseZero(is_forward, whole(-1)),
            hn::IfThenElse(is_forward, whole(1), whole(-1)),
            hn::IfThenElse(is_forward, whole(high), whole(low - 1))};
  }

  static HWY_INLINE Along along(const Axis& axis, VI v, VI edge) {
    const VI low = hn::And(v, hn::Neg(edge));
    const VI plane = hn::Sub(hn::Add(low, hn::And(axis.forward, edge)), whole(axis.origin));
    return {low, hn::Mul(hn::Sub(hn::ConvertTo(df, plane), real(axis.rest)), axis.inverse)};
  }

  HWY_NOINLINE void resolve(unsigned lanes, VI edge, VI& voxels, Voxels& beyond, MI& counts,
                            MI& goes_on) const {
    HWY_ALIGN std::int32_t x[kWidth], y[kWidth], z[kWidth], edges[kWidth], n[kWidth];
    HWY_ALIGN std::int32_t bx[kWidth], by[kWidth], bz[kWidth];
    store(at_, x, y, z);
    store(beyond, bx, by, bz);
    hn::Store(edge, di, edges);
    hn::Store(voxels, di, n);
    unsigned count_bits = bits_of(counts), on_bits = bits_of(goes_on);
    for (unsigned left = lanes; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const ExactStep step = rays_.step(i, {x[i], y[i], z[i]}, edges[i]);
      bx[i] = step.beyond[0];
      by[i] = step.beyond[1];
      bz[i] = step.beyond[2];
      n[i] = step.voxels;
      if (!step.has_length) count_bits &= ~(1U << static_cast<unsigned>(i));
      on_bits &= ~(1U << static_cast<unsigned>(i));
      if (step.goes_on) on_bits |= 1U << static_cast<unsigned>(i);
    }
    voxels = hn::Load(di, n);
    beyond = {hn::Load(di, bx), hn::Load(di, by), hn::Load(di, bz)};
    counts = lanes_of(count_bits);
    goes_on = lanes_of(on_bits);
  }

 public:
  static HWY_INLINE void store(const Voxels& v, std::int32_t* x, std::int32_t* y, std::int32_t* z) {
    hn::Store(v.x, di, x);
    hn::Store(v.y, di, y);
    hn::Store(v.z, di, z);
  }

 private:
  HWY_INLINE void find_nodes(const Voxels& v) {
    node_ = hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<7>(v.x), whole(table_->nodes[1])),
                                    hn::ShiftRight<7>(v.y)),
                            whole(table_->nodes[2])),
                    hn::ShiftRight<7>(v.z));
    first_ = gather(table_->node_entries, node_);
  }

  // Lane by lane: two gathers, one waiting for the other, take longer.
  HWY_INLINE void fetch_words() {
    HWY_ALIGN std::uint32_t bricks[kWidth], in_bricks[kWidth];
    hn::Store(hn::BitCast(du, hn::Add(first_, brick_of(at_))), du, bricks);
    hn::Store(hn::BitCast(du, in_brick(at_)), du, in_bricks);
    const std::uint32_t* entries = table_->entries.data();
    const std::uint16_t* words = table_->words.data();
    for (std::size_t i = 0; i < kWidth; ++i) {
      // Without branches, which nothing foretells; there is a word at 0 too.
      const std::uint32_t entry = entries[bricks[i]];
      const std::uint32_t uniform = 0U - (entry >> 31U);
      static_assert(ClassicTable::kUniform == 1U << 31U);
      const std::uint32_t own = words[(entry + in_bricks[i]) & ~uniform];
      words_[i] = (entry & uniform) | (own & ~uniform);
    }
  }

  HWY_INLINE void move_to(const Voxels& beyond) {
    const Voxels before = at_;
    at_ = {hn::IfThenElse(active_, beyond.x, at_.x), hn::IfThenElse(active_, beyond.y, at_.y),
           hn::IfThenElse(active_, beyond.z, at_.z)};
    const VI moved = hn::Or(hn::Or(hn::Xor(at_.x, before.x), hn::Xor(at_.y, before.y)),
                            hn::Xor(at_.z, before.z));
    if (!hn::AllTrue(di, hn::Lt(moved, whole(128)))) find_nodes(at_);
  }

  const ClassicTable* table_ = nullptr;
  ExactRays rays_;
  Axis x_{}, y_{}, z_{};
  VF t_, end_, near_error_;
  MI active_;
  Voxels at_;
  alignas(64) std::uint32_t words_[kWidth];  // of the cubes that they are in
  VI node_, first_;                          // each lane's node and its first entry
};

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
