// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Compiled once per instruction set. Uses double precision and operations that IEEE 754 rounds
// correctly, in a fixed order, so that all sets give the bits of a plain scalar loop.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "update/block_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <cstring>

#include "block_kernels.hpp"
#include "viewgain/support/isa_dispatch.hpp"
#include "viewgain/support/log_odds_code.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::CappedTag<double, 8>;  // a row of a block, or a part of it
constexpr DF df;
constexpr hn::RebindToSigned<DF> di;
constexpr hn::Rebind<std::int32_t, DF> di32;
constexpr hn::Rebind<std::int8_t, DF> di8;
constexpr hn::RebindToUnsigned<DF> du;
constexpr hn::Rebind<std::uint32_t, DF> du32;
constexpr hn::Rebind<float, DF> df32;
using VF = hn::Vec<DF>;
using MF = hn::Mask<DF>;

// OpenCV's lens model; clears lanes beyond the fold.
HWY_INLINE void distort(const ConeCamera& camera, VF& x, VF& y, MF& seen) {
  const auto& d = camera.distortion;
  const VF k1 = hn::Set(df, d[0]), k2 = hn::Set(df, d[1]), k3 = hn::Set(df, d[4]);
  const VF p1 = hn::Set(df, d[2]), p2 = hn::Set(df, d[3]);
  const VF one = hn::Set(df, 1.0), two = hn::Set(df, 2.0);
  const VF xx = hn::Mul(x, x), yy = hn::Mul(y, y), xy2 = hn::Mul(two, hn::Mul(x, y));
  const VF r2 = hn::Add(xx, yy);
  seen = hn::And(seen, hn::Lt(r2, hn::Set(df, camera.fold_r2)));
  const VF radial =
      hn::Add(one, hn::Mul(r2, hn::Add(k1, hn::Mul(r2, hn::Add(k2, hn::Mul(r2, k3))))));
  const VF tangential_x = hn::Add(hn::Mul(p1, xy2), hn::Mul(p2, hn::Add(r2, hn::Mul(two, xx))));
  const VF tangential_y = hn::Add(hn::Mul(p1, hn::Add(r2, hn::Mul(two, yy))), hn::Mul(p2, xy2));
  x = hn::Add(hn::Mul(x, radial), tangential_x);
  y = hn::Add(hn::Mul(y, radial), tangential_y);
}

// Converts a non-negative integer below 2^51 held as a double to an integer: its bits after adding
// 2^52.
HWY_INLINE hn::Vec<decltype(di)> small_integer(VF value) {
  return hn::And(hn::BitCast(di, hn::Add(value, hn::Set(df, 4503599627370496.0))),
                 hn::Set(di, (std::int64_t{1} << 52) - 1));
}

// The pixel of a point, where a coordinate lies within this of the middle between two pixels, is
// found by quotients; elsewhere by a reciprocal, whose error is about 1e-12.
constexpr double kNearEdge = 1e-6;  // [pixels]

template <bool kDistorted>
bool project(const ConeCamera& camera, const ConePixels& pixels, double voxel_size, Index3 origin,
             int edge, std::int8_t* HWY_RESTRICT deltas) {
  const auto& T = camera.T_camera_grid;
  const VF zero = hn::Zero(df), half = hn::Set(df, 0.5), one = hn::Set(df, 1.0);
  const VF eight = hn::Set(df, 8.0);
  const VF low_edge = hn::Set(df, kNearEdge), high_edge = hn::Set(df, 1.0 - kNearEdge);
  const VF none = hn::Set(df, kNoDelta);
  const VF fx = hn::Set(df, camera.fx), fy = hn::Set(df, camera.fy);
  const VF cx = hn::Set(df, camera.cx), cy = hn::Set(df, camera.cy);
  const VF width = hn::Set(df, camera.width), height = hn::Set(df, camera.height);
  const VF V = hn::Set(df, voxel_size);
  const auto step = static_cast<int>(hn::Lanes(df));
  bool any = false;

  for (int i = 0; i < edge; ++i) {
    const double gx = (origin.x + i + 0.5) * voxel_size;
    for (int j = 0; j < edge; ++j) {
      const double gy = (origin.y + j + 0.5) * voxel_size;
      const VF row_x = hn::Set(df, T[0] * gx + T[1] * gy);
      const VF row_y = hn::Set(df, T[4] * gx + T[5] * gy);
      const VF row_z = hn::Set(df, T[8] * gx + T[9] * gy);
      for (int k = 0; k < edge; k += step) {
        std::int8_t* out = deltas + (i * 64 + j * 8 + k);
        const VF gz = hn::Mul(hn::Add(hn::Iota(df, origin.z + k), half), V);
        const VF px = hn::Add(hn::Add(row_x, hn::Mul(hn::Set(df, T[2]), gz)), hn::Set(df, T[3]));
        const VF py = hn::Add(hn::Add(row_y, hn::Mul(hn::Set(df, T[6]), gz)), hn::Set(df, T[7]));
        const VF pz = hn::Add(hn::Add(row_z, hn::Mul(hn::Set(df, T[10]), gz)), hn::Set(df, T[11]));
        MF seen = hn::Gt(pz, zero);
        VF u, v;
        const auto place = [&](VF x, VF y) {
          u = hn::Add(hn::Add(hn::Mul(fx, x), cx), half);
          v = hn::Add(hn::Add(hn::Mul(fy, y), cy), half);
        };
        if constexpr (kDistorted) {
          VF x = hn::Div(px, pz), y = hn::Div(py, pz);
          distort(camera, x, y, seen);
          place(x, y);
        } else {
          const VF inverse = hn::Div(one, pz);
          place(hn::Mul(px, inverse), hn::Mul(py, inverse));
          const VF right = hn::Sub(u, hn::Floor(u)), below = hn::Sub(v, hn::Floor(v));
          const MF is_near = hn::Or(hn::Lt(hn::Min(right, below), low_edge),
                                    hn::Gt(hn::Max(right, below), high_edge));
          if (!hn::AllFalse(df, hn::And(seen, is_near))) place(hn::Div(px, pz), hn::Div(py, pz));
        }
        u = hn::Floor(u);
        v = hn::Floor(v);
        seen = hn::And(seen, hn::And(hn::Ge(u, zero), hn::Lt(u, width)));
        seen = hn::And(seen, hn::And(hn::Ge(v, zero), hn::Lt(v, height)));
        if (hn::AllFalse(df, seen)) {
          hn::StoreU(hn::Set(di8, kNoDelta), di8, out);
          continue;
        }
        const VF pixel = hn::IfThenElseZero(seen, hn::Add(hn::Mul(v, width), u));
        const auto bounds = hn::GatherIndex(du, pixels.bounds, small_integer(pixel));
        const auto bound = [](auto half_of_bounds) {
          return hn::PromoteTo(df, hn::BitCast(df32, hn::TruncateTo(du32, half_of_bounds)));
        };
        const VF clear = bound(bounds), farthest = bound(hn::ShiftRight<32>(bounds));
        const VF range2 = hn::Add(hn::Add(hn::Mul(px, px), hn::Mul(py, py)), hn::Mul(pz, pz));
        const MF within = hn::And(seen, hn::Lt(range2, hn::Mul(farthest, farthest)));
        if (hn::AllFalse(df, within)) {
          hn::StoreU(hn::Set(di8, kNoDelta), di8, out);
          continue;
        }
        const MF in_full = hn::Lt(range2, hn::Mul(clear, clear));
        if (hn::AllFalse(df, hn::AndNot(in_full, within))) {
          any = true;
          const VF delta = hn::IfThenElse(within, hn::Sub(zero, eight), none);
          hn::StoreU(hn::DemoteTo(di8, hn::DemoteTo(di32, delta)), di8, out);
          continue;
        }
        const auto index = small_integer(hn::Add(pixel, pixel));
        const VF reach = hn::GatherIndex(df, pixels.reach_taper, index);
        const VF range = hn::Sqrt(range2);
        const MF crossed = hn::And(seen, hn::Lt(range, reach));
        if (hn::AllFalse(df, crossed)) {
          hn::StoreU(hn::Set(di8, kNoDelta), di8, out);
          continue;
        }
        any = true;
        const VF taper = hn::GatherIndex(df, pixels.reach_taper + 1, index);
        const VF gap = hn::Sub(reach, range);
        const MF tapered = hn::And(crossed, hn::Lt(gap, taper));
        VF weight = eight;
        if (!hn::AllFalse(df, tapered)) {
          const VF part = hn::Floor(hn::Add(hn::Mul(eight, hn::Div(gap, taper)), half));
          weight = hn::IfThenElse(tapered, part, eight);
        }
        const VF delta = hn::IfThenElse(crossed, hn::Sub(zero, weight), none);
        hn::StoreU(hn::DemoteTo(di8, hn::DemoteTo(di32, delta)), di8, out);
      }
    }
  }
  return any;
}

bool project_any(const ConeCamera& camera, const ConePixels& pixels, double voxel_size,
                 Index3 origin, int edge, std::int8_t* deltas) {
  return camera.distorted ? project<true>(camera, pixels, voxel_size, origin, edge, deltas)
                          : project<false>(camera, pixels, voxel_size, origin, edge, deltas);
}

void update(const std::int8_t* HWY_RESTRICT deltas, bool literal, std::uint8_t* HWY_RESTRICT codes,
            BlockUpdate& result) {
  // Codes are at most 111, so they fit in signed bytes; 111 + 17 saturates and is clamped.
  constexpr hn::CappedTag<std::int8_t, 64> d8;
  const auto zero = hn::Zero(d8), zero_code = hn::Set(d8, kZeroCode);
  const auto low = hn::Set(d8, kMinCode), high = hn::Set(d8, kMaxCode);
  const auto free = hn::Set(d8, kLiteralFreeCode), occupied = hn::Set(d8, kLiteralOccupiedCode);
  const auto none = hn::Set(d8, kNoDelta);
  auto* signed_codes = reinterpret_cast<std::int8_t*>(codes);
  std::uint8_t non_free[64 + 8], crossed[64 + 8];  // StoreMaskBits may write 8 bytes
  auto differs = hn::MaskFromVec(zero);
  auto first = zero;
  const std::size_t step = hn::Lanes(d8);
  for (std::size_t i = 0; i < kBlockVoxels; i += step) {
    const auto before = hn::LoadU(d8, signed_codes + i);
    const auto delta = hn::LoadU(d8, deltas + i);
    const auto silent = hn::Eq(delta, none);
    const auto miss = hn::Not(hn::Or(silent, hn::Gt(delta, zero)));
    const auto from = hn::IfThenElse(hn::Eq(before, zero), zero_code, before);
    auto after = hn::Min(hn::Max(hn::SaturatedAdd(from, delta), low), high);
    if (literal) after = hn::IfThenElse(hn::Gt(delta, zero), occupied, free);
    after = hn::IfThenElse(silent, before, after);
    hn::StoreU(after, d8, signed_codes + i);
    if (i == 0) first = hn::Set(d8, signed_codes[0]);
    differs = hn::Or(differs, hn::Ne(after, first));
    hn::StoreMaskBits(d8, hn::Or(hn::Eq(after, zero), hn::Gt(after, zero_code)), non_free + i / 8);
    hn::StoreMaskBits(d8, miss, crossed + i / 8);
  }
  std::memcpy(result.non_free.data(), non_free, 64);
  std::memcpy(result.crossed.data(), crossed, 64);
  result.uniform = hn::AllFalse(d8, differs);
}

}  // namespace

const BlockKernels& block_kernels_of_target() {
  static const BlockKernels table{project_any, update};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <limits>

namespace viewgain::detail {
namespace {

/// Smallest r² > 0 at which d/dr of r (1 + k1 r² + k2 r⁴ + k3 r⁶) is zero; infinity if there is
/// none.
double fold_radius_squared(const std::array<double, 5>& d) {
  const auto slope = [&d](double s) {
    return 1.0 + s * (3.0 * d[0] + s * (5.0 * d[1] + s * 7.0 * d[4]));
  };
  // The image plane out to 89.4°, in steps too small for a double root of a lens model, then
  // bisection.
  double below = 0;
  for (double r = 0.01; r < 100.0; r *= 1.01) {
    double above = r * r;
    if (slope(above) > 0) {
      below = above;
      continue;
    }
    for (int i = 0; i < 200; ++i) {
      const double middle = 0.5 * (below + above);
      (slope(middle) > 0 ? below : above) = middle;
    }
    return below;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

ConeCamera::ConeCamera(const PinholeCamera& camera, const Pose& T_camera_grid_pose)
    : T_camera_grid(T_camera_grid_pose.m),
      fx(camera.fx),
      fy(camera.fy),
      cx(camera.cx),
      cy(camera.cy),
      distortion(camera.distortion),
      distorted(camera.has_distortion()),
      fold_r2(fold_radius_squared(camera.distortion)),
      width(camera.width),
      height(camera.height) {}

const BlockKernels& block_kernels(Isa isa) {
  return VIEWGAIN_OF_ISA(isa, block_kernels_of_target)();
}

}  // namespace viewgain::detail
#endif
