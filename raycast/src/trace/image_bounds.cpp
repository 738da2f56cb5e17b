// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Outlines of boxes in the image, sixteen at a time. Compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/image_bounds.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "image_bounds.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Rounding moves a bound by less than this many rays.
constexpr float kRayMargin = 0.05F;

constexpr hn::CappedTag<float, kBoxVector> df;
using VF = hn::Vec<decltype(df)>;

// A rectangle of slopes, and one of distorted slopes.
struct Outline {
  VF low_x, high_x, low_y, high_y;
};

// Bounds of what the lens makes of the part of a rectangle that is in the field. For a smooth f,
// |f - linear interpolation between the corners| is at most w² max|f_xx| / 8 + h² max|f_yy| / 8.
HWY_INLINE Outline bent(const LensBend& lens, const Outline& slopes) {
  const auto within = [](VF v, float low, float high) HWY_ATTR {
    return hn::Min(hn::Max(v, hn::Set(df, low)), hn::Set(df, high));
  };
  const VF x0 = within(slopes.low_x, lens.low_x, lens.high_x),
           x1 = within(slopes.high_x, lens.low_x, lens.high_x),
           y0 = within(slopes.low_y, lens.low_y, lens.high_y),
           y1 = within(slopes.high_y, lens.low_y, lens.high_y);
  const VF one = hn::Set(df, 1.0F), two = hn::Set(df, 2.0F);
  const VF p1 = hn::Set(df, lens.p1), p2 = hn::Set(df, lens.p2);
  Outline out{hn::Set(df, kEverywhere), hn::Set(df, -kEverywhere), hn::Set(df, kEverywhere),
              hn::Set(df, -kEverywhere)};
  const auto corner = [&](VF x, VF y) HWY_ATTR {
    const VF xx = hn::Mul(x, x), yy = hn::Mul(y, y), xy = hn::Mul(x, y), rr = hn::Add(xx, yy);
    VF radial = hn::MulAdd(hn::Set(df, lens.k3), rr, hn::Set(df, lens.k2));
    radial = hn::MulAdd(radial, rr, hn::Set(df, lens.k1));
    radial = hn::MulAdd(radial, rr, one);
    const VF u = hn::MulAdd(x, radial,
                            hn::MulAdd(hn::Mul(two, p1), xy, hn::Mul(p2, hn::MulAdd(two, xx, rr))));
    const VF v = hn::MulAdd(y, radial,
                            hn::MulAdd(hn::Mul(two, p2), xy, hn::Mul(p1, hn::MulAdd(two, yy, rr))));
    out.low_x = hn::Min(out.low_x, u);
    out.high_x = hn::Max(out.high_x, u);
    out.low_y = hn::Min(out.low_y, v);
    out.high_y = hn::Max(out.high_y, v);
  };
  corner(x0, y0);
  corner(x1, y0);
  corner(x0, y1);
  corner(x1, y1);
  const VF width = hn::Sub(x1, x0), height = hn::Sub(y1, y0);
  const VF ww = hn::Mul(width, width), hh = hn::Mul(height, height);
  const auto off = [&](float along_x, float along_y) HWY_ATTR {
    return hn::MulAdd(ww, hn::Set(df, along_x / 8.0F), hn::Mul(hh, hn::Set(df, along_y / 8.0F)));
  };
  const VF off_x = off(lens.column_xx, lens.column_yy), off_y = off(lens.row_xx, lens.row_yy);
  return {hn::Sub(out.low_x, off_x), hn::Add(out.high_x, off_x), hn::Sub(out.low_y, off_y),
          hn::Add(out.high_y, off_y)};
}

ImageBounds bounds_of(const BoxArrays& boxes, std::size_t first, const PoseFrame& frame,
                      const ImageScale& image) {
  ImageBounds out;
  const auto& R = frame.rotation;
  const VF zero = hn::Zero(df), nearest = hn::Set(df, image.nearest);
  const VF margin = hn::Set(df, image.margin), ray_margin = hn::Set(df, kRayMargin);
  const VF touching = hn::Set(df, image.touching), opposite = hn::Neg(touching);
  const VF everywhere = hn::Set(df, kEverywhere), nowhere = hn::Neg(everywhere);
  for (std::size_t i = 0; i < kBoxVector; i += hn::Lanes(df)) {
    const std::size_t at = first + i;
    const VF dx = hn::Sub(hn::LoadU(df, &boxes.center_x[at]), hn::Set(df, frame.origin[0]));
    const VF dy = hn::Sub(hn::LoadU(df, &boxes.center_y[at]), hn::Set(df, frame.origin[1]));
    const VF dz = hn::Sub(hn::LoadU(df, &boxes.center_z[at]), hn::Set(df, frame.origin[2]));
    const VF hx = hn::LoadU(df, &boxes.half_x[at]), hy = hn::LoadU(df, &boxes.half_y[at]),
             hz = hn::LoadU(df, &boxes.half_z[at]);
    // The box in the camera's axes: centre and reach along each.
    const auto along = [&](std::size_t axis, VF& center, VF& low, VF& high) HWY_ATTR {
      const VF a = hn::Set(df, R[axis]), b = hn::Set(df, R[3 + axis]), c = hn::Set(df, R[6 + axis]);
      center = hn::Add(hn::Mul(a, dx), hn::Add(hn::Mul(b, dy), hn::Mul(c, dz)));
      const VF reach =
          hn::Add(margin, hn::Add(hn::Mul(hn::Abs(a), hx),
                                  hn::Add(hn::Mul(hn::Abs(b), hy), hn::Mul(hn::Abs(c), hz))));
      low = hn::Sub(center, reach);
      high = hn::Add(center, reach);
    };
    VF x, y, z, x_low, x_high, y_low, y_high, z_low, z_high;
    along(0, x, x_low, x_high);
    along(1, y, y_low, y_high);
    along(2, z, z_low, z_high);
    // Of a box that reaches the camera's plane only the part before it counts.
    const auto behind = hn::Lt(z_high, nearest);
    const VF z_near = hn::Max(z_low, nearest);
    // Rays that count from the camera on may meet what touches it in any direction.
    const auto beside = [&](VF low, VF high) HWY_ATTR {
      return hn::And(hn::Le(low, touching), hn::Ge(high, opposite));
    };
    const auto touches = hn::And(hn::And(beside(x_low, x_high), beside(y_low, y_high)),
                                 hn::And(hn::Le(z_low, nearest), hn::Ge(z_high, opposite)));
    hn::Store(hn::IfThenElse(touches, zero, z_near), df, out.near + i);
    const VF one = hn::Set(df, 1.0F);
    const VF by_near = hn::Div(one, z_near);
    const VF by_far = hn::Div(one, hn::Max(z_high, nearest));
    const auto least = [&](VF low) HWY_ATTR {
      return hn::Mul(low, hn::IfThenElse(hn::Lt(low, zero), by_near, by_far));
    };
    const auto most = [&](VF high) HWY_ATTR {
      return hn::Mul(high, hn::IfThenElse(hn::Lt(high, zero), by_far, by_near));
    };
    // x / z = s + (x - s z) / z for any s. With the slope of the centre for s, depth and sideways
    // extent of a box beside the axis, which go together, are not counted twice.
    const VF by_center = hn::Div(one, hn::Max(z, nearest));
    const auto slopes = [&](std::size_t axis, VF center, VF low, VF high, VF& least_slope,
                            VF& most_slope) HWY_ATTR {
      const VF s = hn::Mul(center, by_center);
      const auto extent = [&](std::size_t k, VF half) HWY_ATTR {
        const VF r = hn::Sub(hn::Set(df, R[3 * k + axis]), hn::Mul(s, hn::Set(df, R[3 * k + 2])));
        return hn::Mul(hn::Abs(r), half);
      };
      const VF off = hn::Sub(center, hn::Mul(s, z));
      const VF reach = hn::Add(hn::MulAdd(hn::Abs(s), margin, margin),
                               hn::Add(extent(0, hx), hn::Add(extent(1, hy), extent(2, hz))));
      least_slope = hn::Max(least(low), hn::Add(s, least(hn::Sub(off, reach))));
      most_slope = hn::Min(most(high), hn::Add(s, most(hn::Add(off, reach))));
    };
    Outline outline;
    slopes(0, x, x_low, x_high, outline.low_x, outline.high_x);
    slopes(1, y, y_low, y_high, outline.low_y, outline.high_y);
    auto unseen = behind;
    if (image.lens.is_bent) {
      const LensBend& lens = image.lens;
      // What lies beside the field no ray meets.
      const auto beyond = [&](VF low, VF high, float field_low, float field_high) HWY_ATTR {
        return hn::Or(hn::Gt(low, hn::Set(df, field_high)), hn::Lt(high, hn::Set(df, field_low)));
      };
      unseen =
          hn::Or(unseen, hn::Or(beyond(outline.low_x, outline.high_x, lens.low_x, lens.high_x),
                                beyond(outline.low_y, outline.high_y, lens.low_y, lens.high_y)));
      outline = bent(lens, outline);
    }
    const auto put = [&](VF low, VF high, float scale, float shift, float* min_out,
                         float* max_out) HWY_ATTR {
      const VF s = hn::Set(df, scale), o = hn::Set(df, shift);
      const VF min = hn::Sub(hn::Add(hn::Mul(low, s), o), ray_margin);
      const VF max = hn::Add(hn::Add(hn::Mul(high, s), o), ray_margin);
      hn::Store(hn::IfThenElse(touches, nowhere, min), df, min_out + i);
      hn::Store(hn::IfThenElse(touches, everywhere, hn::IfThenElse(unseen, nowhere, max)), df,
                max_out + i);
    };
    put(outline.low_x, outline.high_x, image.scale_x, image.shift_x, out.min_column,
        out.max_column);
    put(outline.low_y, outline.high_y, image.scale_y, image.shift_y, out.min_row, out.max_row);
  }
  return out;
}

std::uint32_t covering(const std::int16_t* column0, const std::int16_t* column1,
                       const std::int16_t* row0, const std::int16_t* row1, std::int16_t column,
                       std::int16_t row) {
  constexpr hn::CappedTag<std::int16_t, kBoxVector> d;
  const auto c = hn::Set(d, column), r = hn::Set(d, row);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kBoxVector; i += hn::Lanes(d)) {
    const auto outside =
        hn::Or(hn::Or(hn::Gt(hn::LoadU(d, column0 + i), c), hn::Lt(hn::LoadU(d, column1 + i), c)),
               hn::Or(hn::Gt(hn::LoadU(d, row0 + i), r), hn::Lt(hn::LoadU(d, row1 + i), r)));
    std::uint8_t part[8] = {};
    hn::StoreMaskBits(d, hn::Not(outside), part);
    bits |= (static_cast<std::uint32_t>(part[0]) | static_cast<std::uint32_t>(part[1]) << 8U) << i;
  }
  return bits;
}

}  // namespace

const ImageBoundsKernels& image_bounds_of_target() {
  static const ImageBoundsKernels table{bounds_of, covering};
  return table;
}

}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viewgain::detail {

LensBend::LensBend(const PinholeCamera& camera, const TileTable& table) {
  if (!camera.has_distortion()) return;
  is_bent = true;
  const auto [a, b, c, d, e] = camera.distortion;
  k1 = static_cast<float>(a), k2 = static_cast<float>(b), k3 = static_cast<float>(e);
  p1 = static_cast<float>(c), p2 = static_cast<float>(d);
  for (std::size_t tile = 0; tile < table.tile_count; ++tile) {
    const float* x = table.directions.data() + tile * 3 * kTileRays;
    for (int lane = 0; lane < kTileRays; ++lane) {
      if ((table.valid[tile] >> lane & 1) == 0) continue;
      const float z = x[2 * kTileRays + lane];
      low_x = std::min(low_x, x[lane] / z), high_x = std::max(high_x, x[lane] / z);
      low_y = std::min(low_y, x[kTileRays + lane] / z);
      high_y = std::max(high_y, x[kTileRays + lane] / z);
    }
  }
  constexpr float kWider = 1e-5F;  // than rounding
  low_x -= kWider, high_x += kWider, low_y -= kWider, high_y += kWider;
  // Of x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (3 x² + y²), term by term, at the largest x,
  // y.
  const double X = std::max(-low_x, high_x), Y = std::max(-low_y, high_y);
  const double A = std::abs(a), B = std::abs(b), E = std::abs(e);
  const auto along = [&](double x, double y, double tangential) {
    return A * 6 * x + B * (20 * x * x * x + 12 * x * y * y) +
           E * (42 * std::pow(x, 5) + 60 * x * x * x * y * y + 18 * x * std::pow(y, 4)) +
           6 * tangential;
  };
  const auto across = [&](double x, double y, double tangential) {
    return A * 2 * x + B * (4 * x * x * x + 12 * x * y * y) +
           E * (6 * std::pow(x, 5) + 36 * x * x * x * y * y + 30 * x * std::pow(y, 4)) +
           2 * tangential;
  };
  column_xx = static_cast<float>(along(X, Y, std::abs(d)));
  column_yy = static_cast<float>(across(X, Y, std::abs(d)));
  row_yy = static_cast<float>(along(Y, X, std::abs(c)));
  row_xx = static_cast<float>(across(Y, X, std::abs(c)));
}

const ImageBoundsKernels& image_bounds_kernels(Isa isa) {
  switch (isa) {
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return N_AVX3::image_bounds_of_target();
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return N_AVX2::image_bounds_of_target();
#endif
    default:
      return HWY_STATIC_DISPATCH(image_bounds_of_target)();
  }
}

}  // namespace viewgain::detail
#endif
