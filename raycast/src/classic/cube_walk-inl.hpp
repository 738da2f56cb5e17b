// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Takes packets of rays through a ClassicTable in order, cube by cube, in double precision: what
// OrderedRay does, a ray a lane. Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_CUBE_WALK_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_CUBE_WALK_INL_HPP
#undef VIEWGAIN_CUBE_WALK_INL_HPP
#else
#define VIEWGAIN_CUBE_WALK_INL_HPP
#endif

#include <hwy/highway.h>

#include <bit>

#include "classic_walk.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// At most 8 lanes: half a tile.
using DD = hn::CappedTag<double, 8>;
using DL = hn::RebindToSigned<DD>;
constexpr DD dd;
constexpr DL dl;
using VD = hn::Vec<DD>;
using VL = hn::Vec<DL>;
using MD = hn::Mask<DD>;
using ML = hn::Mask<DL>;
constexpr std::size_t kLanes = hn::MaxLanes(dd);

HWY_INLINE VD real(double v) { return hn::Set(dd, v); }
HWY_INLINE VL whole(std::int64_t v) { return hn::Set(dl, v); }
HWY_INLINE MD to_d(ML m) { return hn::RebindMask(dd, m); }
HWY_INLINE ML to_l(MD m) { return hn::RebindMask(dl, m); }
HWY_INLINE ML no_lane() { return hn::Lt(hn::Zero(dl), hn::Zero(dl)); }

// Whole numbers from 0 to 2^51 between the two: added to 2^52 they are a double's lowest bits.
constexpr double kTwoTo52 = 4503599627370496.0;
HWY_INLINE VL bits_of(VD v) { return hn::BitCast(dl, hn::Add(v, real(kTwoTo52))); }
HWY_INLINE VL integer_of(VD v) { return hn::And(bits_of(v), whole((std::int64_t{1} << 51) - 1)); }
HWY_INLINE VD real_of(VL v) {
  const VL exponent = hn::BitCast(dl, real(kTwoTo52));
  return hn::Sub(hn::BitCast(dd, hn::Or(v, exponent)), real(kTwoTo52));
}

HWY_INLINE unsigned bits_of(ML mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(dl, mask, bits);
  return bits[0] & ((1U << kLanes) - 1U);
}

HWY_INLINE VL gather(const std::vector<std::uint32_t>& table, VL index) {
#if HWY_TARGET == HWY_AVX3
  return VL{_mm512_cvtepu32_epi64(_mm512_i64gather_epi32(index.raw, table.data(), 4))};
#elif HWY_TARGET == HWY_AVX2
  return VL{_mm256_cvtepu32_epi64(
      _mm256_i64gather_epi32(reinterpret_cast<const int*>(table.data()), index.raw, 4))};
#else
  HWY_ALIGN std::int64_t lanes[kLanes];
  hn::Store(index, dl, lanes);
  for (std::int64_t& lane : lanes) lane = table[static_cast<std::size_t>(lane)];
  return hn::Load(dl, lanes);
#endif
}

// Four bytes that end in the word; indices are above 0.
HWY_INLINE VL gather(const std::vector<std::uint16_t>& table, VL index) {
#if HWY_TARGET == HWY_AVX3
  const VL four{_mm512_cvtepu32_epi64(_mm512_i64gather_epi32(index.raw, table.data() - 1, 2))};
  return hn::ShiftRight<16>(four);
#elif HWY_TARGET == HWY_AVX2
  const VL four{_mm256_cvtepu32_epi64(
      _mm256_i64gather_epi32(reinterpret_cast<const int*>(table.data() - 1), index.raw, 2))};
  return hn::ShiftRight<16>(four);
#else
  HWY_ALIGN std::int64_t lanes[kLanes];
  hn::Store(index, dl, lanes);
  for (std::int64_t& lane : lanes) lane = table[static_cast<std::size_t>(lane)];
  return hn::Load(dl, lanes);
#endif
}

// Whole numbers, the voxels that rays are in.
struct Voxels {
  VD x, y, z;
};

// What a step leads through: voxels that are the same.
struct CubeStep {
  VL word;     // as ClassicTable's
  Voxels at;   // the first
  VD voxels;   // how many
  VD t, next;  // from where to where
  ML counts;   // lanes for which it has a length
};

// One axis of a packet's rays.
struct Axis {
  double origin;
  VD direction, inverse;
  VD forward;  // 1 where the ray runs towards larger voxels, else 0
};

class CubeWalk {
 public:
  // False if no ray goes anywhere.
  HWY_INLINE bool begin(const ClassicView& view, const ClassicTile& tile, std::size_t lane0) {
    table_ = &view.table;
    splits_unknown_ = view.is_distinct;
    t_ = real(view.min_range);
    end_ = hn::Load(dd, tile.far + lane0);
    begin_axis(view, tile.dx + lane0, 0, x_);
    begin_axis(view, tile.dy + lane0, 1, y_);
    begin_axis(view, tile.dz + lane0, 2, z_);
    const VL lane = hn::Shl(whole(1), hn::Iota(dl, static_cast<std::int64_t>(lane0)));
    active_ = hn::And(hn::TestBit(whole(tile.valid), lane), to_l(hn::Lt(t_, end_)));
    if (hn::AllFalse(dl, active_)) return false;
    const auto first_voxel = [&](const Axis& axis, std::size_t a) HWY_ATTR {
      const VD low = real(table_->offset[a]);
      const VD last = real(table_->offset[a] + table_->size[a] - 1);
      const VD at = hn::Min(hn::Max(voxel_at(axis, t_), low), last);
      return hn::IfThenElse(to_d(active_), at, low);
    };
    at_ = {first_voxel(x_, 0), first_voxel(y_, 1), first_voxel(z_, 2)};
    find_nodes(bits_of(at_.x), bits_of(at_.y), bits_of(at_.z));
    return true;
  }

  // Calls ends = sink.step(CubeStep, distinct), lanes that end there. False if no ray goes on.
  template <typename Sink>
  HWY_INLINE bool step(Sink& sink, DistinctVoxels& distinct) {
    const VL word = word_at();
    VL shift = hn::And(hn::ShiftRight<ClassicTable::kEdgeShift>(word), whole(ClassicTable::kEdge));
    if (splits_unknown_) {
      const VL unknown = hn::And(word, whole(ClassicTable::kUnknown));
      shift = hn::IfThenElseZero(hn::Eq(unknown, hn::Zero(dl)), shift);
    }
    // 2^shift and its reciprocal, by their exponents.
    const VL exponent = hn::ShiftLeft<52>(shift), of_one = hn::BitCast(dl, real(1.0));
    const VD edge = hn::BitCast(dd, hn::Add(of_one, exponent)),
             share = hn::BitCast(dd, hn::Sub(of_one, exponent));
    const Along x = along(x_, at_.x, edge, share), y = along(y_, at_.y, edge, share),
                z = along(z_, at_.z, edge, share);
    const VD exit = hn::Min(x.leaves, hn::Min(y.leaves, z.leaves));
    const VD next = hn::Max(t_, hn::Min(exit, end_));
    const MD leaves = hn::Le(exit, end_);
    const VD top = hn::Sub(edge, real(1.0));
    VD voxels = real(1.0);
    const auto advance = [&](const Axis& axis, VD v, const Along& a) HWY_ATTR {
      const MD crosses = hn::And(leaves, hn::Le(a.leaves, exit));
      const VD far_side = hn::MulAdd(axis.forward, top, a.low);
      const VD inside = hn::Min(hn::Max(voxel_at(axis, next), a.low), hn::Add(a.low, top));
      const VD last = hn::IfThenElse(crosses, far_side, inside);
      voxels = hn::Add(voxels, hn::Abs(hn::Sub(last, v)));
      const VD over = hn::Sub(hn::Add(axis.forward, axis.forward), real(1.0));
      return hn::Add(last, hn::IfThenElseZero(crosses, over));
    };
    const Voxels beyond{advance(x_, at_.x, x), advance(y_, at_.y, y), advance(z_, at_.z, z)};
    const ML counts = hn::And(active_, to_l(hn::Lt(t_, next)));
    const ML ends = sink.step(CubeStep{word, at_, voxels, t_, next, counts}, distinct);
    active_ = hn::AndNot(ends, hn::And(active_, to_l(hn::Lt(exit, end_))));
    if (hn::AllFalse(dl, active_)) return false;
    t_ = next;
    move_to(beyond);
    return true;
  }

 private:
  // How a cube is left along an axis: its lowest voxel, and where on the ray.
  struct Along {
    VD low, leaves;
  };

  HWY_INLINE void begin_axis(const ClassicView& view, const double* direction, std::size_t a,
                             Axis& axis) {
    const VD d = hn::Load(dd, direction);
    // Along an axis that a ray does not move, planes are far away, or at 0 where it starts in one.
    const VD inverse = hn::IfThenElse(hn::Eq(d, hn::Zero(dd)), real(1e300), hn::Div(real(1.0), d));
    axis = {view.origin[a], d, inverse,
            hn::IfThenElseZero(hn::Lt(hn::Zero(dd), inverse), real(1.0))};
    const auto at_plane = [&](double plane) HWY_ATTR {
      return hn::Mul(hn::Sub(real(plane), real(axis.origin)), inverse);
    };
    const VD low = at_plane(table_->offset[a]),
             high = at_plane(table_->offset[a] + table_->size[a]);
    t_ = hn::Max(t_, hn::Min(low, high));
    end_ = hn::Min(end_, hn::Max(low, high));
  }

  static HWY_INLINE VD voxel_at(const Axis& axis, VD t) {
    return hn::Floor(hn::Add(real(axis.origin), hn::Mul(axis.direction, t)));
  }

  static HWY_INLINE Along along(const Axis& axis, VD v, VD edge, VD share) {
    const VD low = hn::Mul(hn::Floor(hn::Mul(v, share)), edge);
    const VD plane = hn::Add(low, hn::Mul(axis.forward, edge));
    return {low, hn::Mul(hn::Sub(plane, real(axis.origin)), axis.inverse)};
  }

  HWY_INLINE void find_nodes(VL x, VL y, VL z) {
    const auto number = [](VL v) HWY_ATTR {
      return hn::And(hn::ShiftRight<7>(v), whole((std::int64_t{1} << 40) - 1));
    };
    // Products of small numbers, as doubles: 64-bit integers have none before AVX-512.
    const VD plane =
        hn::Add(hn::Mul(real_of(number(x)), real(table_->nodes[1])), real_of(number(y)));
    const VD node = hn::Add(hn::Mul(plane, real(table_->nodes[2])), real_of(number(z)));
    first_ = gather(table_->node_entries, integer_of(node));
  }

  [[nodiscard]] HWY_INLINE VL word_at() const {
    const VL x = bits_of(at_.x), y = bits_of(at_.y), z = bits_of(at_.z);
    const VL mask = whole(0x78);
    const VL brick =
        hn::Or(hn::Or(hn::ShiftLeft<5>(hn::And(x, mask)), hn::ShiftLeft<1>(hn::And(y, mask))),
               hn::ShiftRight<3>(hn::And(z, mask)));
    const VL entry = gather(table_->entries, hn::Add(first_, brick));
    const ML is_mixed = hn::Eq(hn::And(entry, whole(ClassicTable::kUniform)), hn::Zero(dl));
    if (hn::AllFalse(dl, hn::And(active_, is_mixed))) return entry;
    // As ClassicTable::word_in_brick().
    const auto part = [](VL v, std::int64_t bits) HWY_ATTR { return hn::And(v, whole(bits)); };
    const VL cube = hn::Or(hn::Or(hn::ShiftLeft<6>(part(x, 4)), hn::ShiftLeft<5>(part(y, 4))),
                           hn::ShiftLeft<4>(part(z, 4)));
    const VL in_cube =
        hn::Or(hn::Or(hn::ShiftLeft<4>(part(x, 3)), hn::ShiftLeft<2>(part(y, 3))), part(z, 3));
    const VL offset = hn::Or(cube, in_cube);
    const VL own =
        gather(table_->words, hn::IfThenElse(is_mixed, hn::Add(entry, offset), whole(1)));
    return hn::IfThenElse(is_mixed, own, entry);
  }

  HWY_INLINE void move_to(const Voxels& beyond) {
    const MD goes_on = to_d(active_);
    const auto moved_to = [&](VD v, VD before)
                              HWY_ATTR { return hn::IfThenElse(goes_on, v, before); };
    const Voxels before = at_;
    at_ = {moved_to(beyond.x, at_.x), moved_to(beyond.y, at_.y), moved_to(beyond.z, at_.z)};
    const VL x = bits_of(at_.x), y = bits_of(at_.y), z = bits_of(at_.z);
    const VL moved = hn::Or(hn::Or(hn::Xor(x, bits_of(before.x)), hn::Xor(y, bits_of(before.y))),
                            hn::Xor(z, bits_of(before.z)));
    if (!hn::AllTrue(dl, hn::Lt(moved, whole(128)))) find_nodes(x, y, z);
  }

  const ClassicTable* table_ = nullptr;
  bool splits_unknown_ = false;
  Axis x_{}, y_{}, z_{};
  VD t_, end_;
  ML active_;
  Voxels at_;
  VL first_;  // entry of each lane's node
};

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
