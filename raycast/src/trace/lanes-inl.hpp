// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Vectors of a ray a lane. Included once for each instruction set; Highway flips the toggle.
#if defined(VIEWGAIN_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_LANES_INL_HPP
#undef VIEWGAIN_LANES_INL_HPP
#else
#define VIEWGAIN_LANES_INL_HPP
#endif

#include <hwy/highway.h>

#include "ray_tile.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// At most 16 lanes: a tile. On x86 this is 16, 8 or 4, a constant.
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

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
