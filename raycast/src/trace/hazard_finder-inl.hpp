// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The Finder of walks through unknown space (brick_walk-inl.hpp): what BrickTable has of voxels.
// Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_HAZARD_FINDER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_HAZARD_FINDER_INL_HPP
#undef VIEWGAIN_HAZARD_FINDER_INL_HPP
#else
#define VIEWGAIN_HAZARD_FINDER_INL_HPP
#endif

#include <hwy/highway.h>

#include "scene/brick_table.hpp"
#include "viewgain/support/brick_walk-inl.hpp"
#include "viewgain/support/gathers-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// How much of unknown space is a step: a voxel; what there is in a cell of the hazard field; or
// what BrickTable joins.
enum class Steps { voxels, cells, joined };

// Finds states and hazard.
template <Steps kSteps>
class HazardFinder {
 public:
  // The entries of bricks and the places of records.
  struct Found {
    VI entry, record;
  };
  struct Place {
    VU state;  // of the voxel, as in BrickTable
    VI edge;
    VF rate;  // of unknown voxels [1/voxel]
    VI entry;
  };

  explicit HWY_INLINE HazardFinder(const BrickTable& table)
      : table_(table), prefetches_(table.records.size() > kNearWords) {}

  HWY_INLINE void begin(const Voxels& at) { find_nodes(at); }

  HWY_INLINE Found find(const Voxels& at, VI moved) {
    if (!stay_in_nodes(moved)) find_nodes(at);
    const VI entry = gather_words(table_.entries.data(), hn::Add(first_, brick_of(at)));
    // Lanes in free bricks read the first record, and do not use it.
    const VI record = hn::IfThenZeroElse(is_free(entry),
                                         hn::Add(first_record(entry), record_in_brick(at, entry)));
    if (prefetches_) {
      prefetch_words(table_.records.data(),
                     table_.rate_shift == 0 ? record : hn::Add(record, record));
    }
    return {entry, record};
  }

  HWY_INLINE Place place(const Found& found, const Voxels& at) const {
    // A free brick's entry is the edge.
    static_assert(BrickTable::kFree == 0 && BrickTable::kFreeVoxel == 0);
    Place place{hn::Zero(du), found.entry, hn::Zero(df), found.entry};
    if (!hn::AllTrue(di, is_free(found.entry))) read(found, at, place);
    if constexpr (kSteps != Steps::joined) {
      const VI most = set_i(kSteps == Steps::voxels ? 1 : 1 << table_.rate_shift);
      const MI unknown =
          hn::RebindMask(di, hn::Eq(place.state, hn::Set(du, BrickTable::kUnknownVoxel)));
      place.edge = hn::IfThenElse(unknown, hn::Min(place.edge, most), place.edge);
    }
    return place;
  }

  [[nodiscard]] static HWY_INLINE MF is_in(const Place& place, std::uint32_t state, MF lanes) {
    return hn::And(lanes, hn::RebindMask(df, hn::Eq(place.state, hn::Set(du, state))));
  }

  // BrickTable::place_of() the field's cells of lanes in unknown voxels.
  [[nodiscard]] HWY_INLINE VI places(const Place& place, const Voxels& at, MF lanes) const {
    const VI within = set_i((1 << table_.rate_shift) - 1);
    const Voxels lowest{hn::AndNot(within, at.x), hn::AndNot(within, at.y),
                        hn::AndNot(within, at.z)};
    return hn::IfThenElseZero(
        to_i(lanes), hn::Add(first_record(place.entry), record_in_brick(lowest, place.entry)));
  }

  // Is what moved so far still in its hazard cell?
  [[nodiscard]] HWY_INLINE MF in_same_cell(VI moved) const {
    return to_f(hn::Lt(moved, set_i(1 << table_.rate_shift)));
  }

 private:
  HWY_INLINE void find_nodes(const Voxels& at) {
    first_ = gather_words(table_.node_entries.data(), node_of(table_, at));
  }

  // The number of a voxel's record in its brick, which has this entry.
  [[nodiscard]] HWY_INLINE VI record_in_brick(const Voxels& at, VI entry) const {
    if (table_.rate_shift == 0) {
      const VI seven = set_i(7);
      return hn::Or(
          hn::Or(hn::ShiftLeft<6>(hn::And(at.x, seven)), hn::ShiftLeft<3>(hn::And(at.y, seven))),
          hn::And(at.z, seven));
    }
    const VI six = set_i(6);
    const VI cube =
        hn::Or(hn::Or(hn::ShiftLeft<3>(hn::And(at.x, six)), hn::ShiftLeft<1>(hn::And(at.y, six))),
               hn::ShiftRight<1>(hn::And(at.z, six)));
    if (table_.rate_shift == 1) return cube;
    // Unknown bricks have records by cells of 4³ or 8³ voxels.
    const VI four = set_i(table_.rate_shift == 2 ? 4 : 0);
    const VI cell = hn::Or(hn::Or(hn::And(at.x, four), hn::ShiftRight<1>(hn::And(at.y, four))),
                           hn::ShiftRight<2>(hn::And(at.z, four)));
    return hn::IfThenElse(hn::Lt(entry, hn::Zero(di)), cube, cell);
  }

  [[nodiscard]] static HWY_INLINE MI is_free(VI entry) {
    return hn::RebindMask(di, hn::Eq(hn::ShiftRight<30>(as_u(entry)), hn::Zero(du)));
  }
  [[nodiscard]] static HWY_INLINE VI first_record(VI entry) {
    return hn::And(entry, set_i(static_cast<std::int32_t>(BrickTable::kPayload)));
  }

  // Fills in what the records of voxels have in bricks that are not free.
  HWY_INLINE void read(const Found& found, const Voxels& at, Place& place) const {
    VU own;
    VI edge;
    if (table_.rate_shift == 0) {
      constexpr std::uint32_t kRest = BrickTable::kStateBits | BrickTable::kTopBits;
      static_assert(BrickTable::kTopBits == 7U << 2U);
      const VI word = gather_words(table_.records.data(), found.record);
      own = hn::And(as_u(word), hn::Set(du, BrickTable::kStateBits));
      edge = hn::Add(hn::And(hn::ShiftRight<2>(word), set_i(7)), set_i(1));
      place.rate = hn::BitCast(df, hn::AndNot(hn::Set(du, kRest), as_u(word)));
    } else {
      const VI one = set_i(1);
      VI states, rate;
      gather_pairs(table_.records.data(), found.record, states, rate);
      const VI bit =
          hn::Or(hn::Or(hn::ShiftLeft<3>(hn::And(at.x, one)), hn::ShiftLeft<2>(hn::And(at.y, one))),
                 hn::ShiftLeft<1>(hn::And(at.z, one)));
      own = hn::And(hn::Shr(as_u(states), as_u(bit)), hn::Set(du, BrickTable::kStateBits));
      edge = hn::ShiftRight<BrickTable::kEdgeShift>(states);
      place.rate = hn::BitCast(df, rate);
    }
    const MI free = is_free(found.entry);
    place.state = hn::IfThenZeroElse(hn::RebindMask(du, free), own);
    place.edge = hn::IfThenElse(free, place.edge, edge);
  }

  // Prefetches cost 3 % where the records are near anyway (1.5 MB); they save 6 % with 2 MB, and
  // 20 % with 7 MB.
  static constexpr std::size_t kNearWords = 448U << 10U;

  const BrickTable& table_;
  bool prefetches_;
  VI first_;  // entry of each lane's node
};

template <bool kMissed>  // what of each cell is left counts, so cells must be told apart
using AreaFinder = HazardFinder<kMissed ? Steps::cells : Steps::joined>;
using VisitFinder = HazardFinder<Steps::voxels>;

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
