// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Vectors with one ray per lane. Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_LANES_INL_HPP
#undef VIEWGAIN_LANES_INL_HPP
#else
#define VIEWGAIN_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include "viewgain/support/walk_task.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// At most 16 lanes, one tile. On x86 a constant: 16, 8 or 4.
using DF = hn::CappedTag<float, kTileRays>;
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
constexpr DF df;
constexpr DU du;
constexpr DI di;
using VF = hn::Vec<DF>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;
using MI = hn::Mask<DI>;
constexpr int kWidth = static_cast<int>(hn::MaxLanes(df));

// The lanes whose bits are set, and the bits of lanes.
HWY_INLINE MF mask_of(std::uint32_t bits) {
  const VU lane_bits = hn::Shl(hn::Set(du, 1U), hn::Iota(du, 0U));
  return hn::RebindMask(df, hn::TestBit(hn::Set(du, bits), lane_bits));
}
HWY_INLINE std::uint32_t bits_of(MF lanes) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(df, lanes, bits);
  return static_cast<std::uint32_t>(bits[0]) | static_cast<std::uint32_t>(bits[1]) << 8U;
}

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
