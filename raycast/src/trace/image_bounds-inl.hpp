// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Outlines of boxes in the image, sixteen at a time. Included once for each instruction set;
// Highway flips the toggle.
#if defined(VIEWGAIN_IMAGE_BOUNDS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef VIEWGAIN_IMAGE_BOUNDS_INL_HPP
#undef VIEWGAIN_IMAGE_BOUNDS_INL_HPP
#else
#define VIEWGAIN_IMAGE_BOUNDS_INL_HPP
#endif

#include <hwy/highway.h>

#include "image_bounds.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Rounding moves a bound by less than this many rays.
constexpr float kRayMargin = 0.05F;

constexpr hn::CappedTag<float, kBoxVector> d_box;
constexpr hn::RebindToSigned<decltype(d_box)> di_box;
using VB = hn::Vec<decltype(d_box)>;

// A rectangle of slopes, and one of distorted slopes.
struct Outline {
  VB low_x, high_x, low_y, high_y;
};

// Bounds of what the lens makes of the part of a rectangle that is in the field. For a smooth f,
// |f - linear interpolation between the corners| is at most w² max|f_xx| / 8 + h² max|f_yy| / 8.
HWY_INLINE Outline bent(const LensBend& lens, const Outline& slopes) {
  const auto within = [](VB v, float low, float high) HWY_ATTR {
    return hn::Min(hn::Max(v, hn::Set(d_box, low)), hn::Set(d_box, high));
  };
  const VB x0 = within(slopes.low_x, lens.low_x, lens.high_x),
           x1 = within(slopes.high_x, lens.low_x, lens.high_x),
           y0 = within(slopes.low_y, lens.low_y, lens.high_y),
           y1 = within(slopes.high_y, lens.low_y, lens.high_y);
  const VB one = hn::Set(d_box, 1.0F), two = hn::Set(d_box, 2.0F);
  const VB p1 = hn::Set(d_box, lens.p1), p2 = hn::Set(d_box, lens.p2);
  Outline out{hn::Set(d_box, kEverywhere), hn::Set(d_box, -kEverywhere),
              hn::Set(d_box, kEverywhere), hn::Set(d_box, -kEverywhere)};
  const auto corner = [&](VB x, VB y) HWY_ATTR {
    const VB xx = hn::Mul(x, x), yy = hn::Mul(y, y), xy = hn::Mul(x, y), rr = hn::Add(xx, yy);
    VB radial = hn::MulAdd(hn::Set(d_box, lens.k3), rr, hn::Set(d_box, lens.k2));
    radial = hn::MulAdd(radial, rr, hn::Set(d_box, lens.k1));
    radial = hn::MulAdd(radial, rr, one);
    const VB u = hn::MulAdd(x, radial,
                            hn::MulAdd(hn::Mul(two, p1), xy, hn::Mul(p2, hn::MulAdd(two, xx, rr))));
    const VB v = hn::MulAdd(y, radial,
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
  const VB width = hn::Sub(x1, x0), height = hn::Sub(y1, y0);
  const VB ww = hn::Mul(width, width), hh = hn::Mul(height, height);
  const auto off = [&](float along_x, float along_y) HWY_ATTR {
    return hn::MulAdd(ww, hn::Set(d_box, along_x / 8.0F),
                      hn::Mul(hh, hn::Set(d_box, along_y / 8.0F)));
  };
  const VB off_x = off(lens.column_xx, lens.column_yy), off_y = off(lens.row_xx, lens.row_yy);
  return {hn::Sub(out.low_x, off_x), hn::Add(out.high_x, off_x), hn::Sub(out.low_y, off_y),
          hn::Add(out.high_y, off_y)};
}

HWY_INLINE void bounds_of(const BoxArrays& boxes, std::size_t first, const PoseFrame& frame,
                          const ImageScale& image, ImageBounds& out) {
  out.seen = 0;
  const auto& R = frame.rotation;
  const VB zero = hn::Zero(d_box), nearest = hn::Set(d_box, image.nearest);
  const VB margin = hn::Set(d_box, image.margin), ray_margin = hn::Set(d_box, kRayMargin);
  const VB touching = hn::Set(d_box, image.touching), opposite = hn::Neg(touching);
  const VB everywhere = hn::Set(d_box, kEverywhere), nowhere = hn::Neg(everywhere);
  for (std::size_t i = 0; i < kBoxVector; i += hn::Lanes(d_box)) {
    const std::size_t at = first + i;
    const VB dx = hn::Sub(hn::LoadU(d_box, &boxes.center_x[at]), hn::Set(d_box, frame.origin[0]));
    const VB dy = hn::Sub(hn::LoadU(d_box, &boxes.center_y[at]), hn::Set(d_box, frame.origin[1]));
    const VB dz = hn::Sub(hn::LoadU(d_box, &boxes.center_z[at]), hn::Set(d_box, frame.origin[2]));
    const VB hx = hn::LoadU(d_box, &boxes.half_x[at]), hy = hn::LoadU(d_box, &boxes.half_y[at]),
             hz = hn::LoadU(d_box, &boxes.half_z[at]);
    // The box in the camera's axes: centre and reach along each.
    const auto along = [&](std::size_t axis, VB& center, VB& low, VB& high) HWY_ATTR {
      const VB a = hn::Set(d_box, R[axis]), b = hn::Set(d_box, R[3 + axis]),
               c = hn::Set(d_box, R[6 + axis]);
      center = hn::Add(hn::Mul(a, dx), hn::Add(hn::Mul(b, dy), hn::Mul(c, dz)));
      const VB reach =
          hn::Add(margin, hn::Add(hn::Mul(hn::Abs(a), hx),
                                  hn::Add(hn::Mul(hn::Abs(b), hy), hn::Mul(hn::Abs(c), hz))));
      low = hn::Sub(center, reach);
      high = hn::Add(center, reach);
    };
    VB x, y, z, x_low, x_high, y_low, y_high, z_low, z_high;
    along(0, x, x_low, x_high);
    along(1, y, y_low, y_high);
    along(2, z, z_low, z_high);
    // Of a box that reaches the camera's plane only the part before it counts.
    const auto behind = hn::Lt(z_high, nearest);
    const VB z_near = hn::Max(z_low, nearest);
    // Rays that count from the camera on may meet what touches it in any direction.
    const auto beside = [&](VB low, VB high) HWY_ATTR {
      return hn::And(hn::Le(low, touching), hn::Ge(high, opposite));
    };
    const auto touches = hn::And(hn::And(beside(x_low, x_high), beside(y_low, y_high)),
                                 hn::And(hn::Le(z_low, nearest), hn::Ge(z_high, opposite)));
    hn::Store(hn::IfThenElse(touches, zero, z_near), d_box, out.near + i);
    const VB one = hn::Set(d_box, 1.0F);
    const VB by_near = hn::Div(one, z_near);
    const VB by_far = hn::Div(one, hn::Max(z_high, nearest));
    const auto least = [&](VB low) HWY_ATTR {
      return hn::Mul(low, hn::IfThenElse(hn::Lt(low, zero), by_near, by_far));
    };
    const auto most = [&](VB high) HWY_ATTR {
      return hn::Mul(high, hn::IfThenElse(hn::Lt(high, zero), by_far, by_near));
    };
    // x / z = s + (x - s z) / z for any s. With the slope of the centre for s, depth and sideways
    // extent of a box beside the axis, which go together, are not counted twice.
    const VB by_center = hn::Div(one, hn::Max(z, nearest));
    const auto slopes = [&](std::size_t axis, VB center, VB low, VB high, VB& least_slope,
                            VB& most_slope) HWY_ATTR {
      const VB s = hn::Mul(center, by_center);
      const auto extent = [&](std::size_t k, VB half) HWY_ATTR {
        const VB r =
            hn::Sub(hn::Set(d_box, R[3 * k + axis]), hn::Mul(s, hn::Set(d_box, R[3 * k + 2])));
        return hn::Mul(hn::Abs(r), half);
      };
      const VB off = hn::Sub(center, hn::Mul(s, z));
      const VB reach = hn::Add(hn::MulAdd(hn::Abs(s), margin, margin),
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
      const auto beyond = [&](VB low, VB high, float field_low, float field_high) HWY_ATTR {
        return hn::Or(hn::Gt(low, hn::Set(d_box, field_high)),
                      hn::Lt(high, hn::Set(d_box, field_low)));
      };
      unseen =
          hn::Or(unseen, hn::Or(beyond(outline.low_x, outline.high_x, lens.low_x, lens.high_x),
                                beyond(outline.low_y, outline.high_y, lens.low_y, lens.high_y)));
      outline = bent(lens, outline);
    }
    // Whole rays, those from the first to the last of the image.
    const auto put = [&](VB low, VB high, float scale, float shift, float last,
                         std::int32_t* first_out, std::int32_t* last_out) HWY_ATTR {
      const VB s = hn::Set(d_box, scale), o = hn::Set(d_box, shift);
      VB min = hn::Sub(hn::Add(hn::Mul(low, s), o), ray_margin);
      VB max = hn::Add(hn::Add(hn::Mul(high, s), o), ray_margin);
      min = hn::Ceil(hn::Max(hn::IfThenElse(touches, nowhere, min), zero));
      max = hn::Floor(hn::Min(hn::IfThenElse(touches, everywhere, max), hn::Set(d_box, last)));
      const auto is_empty = hn::Not(hn::Le(min, max));
      // Empty ones may be far away.
      const auto whole = [&](VB v) HWY_ATTR {
        return hn::ConvertTo(di_box, hn::IfThenElse(is_empty, zero, v));
      };
      hn::Store(whole(min), di_box, first_out + i);
      hn::Store(whole(max), di_box, last_out + i);
      return is_empty;
    };
    const auto no_column = put(outline.low_x, outline.high_x, image.scale_x, image.shift_x,
                               image.last_column, out.column0, out.column1);
    const auto no_row = put(outline.low_y, outline.high_y, image.scale_y, image.shift_y,
                            image.last_row, out.row0, out.row1);
    const auto seen = hn::AndNot(hn::Or(no_column, no_row), hn::Or(touches, hn::Not(unseen)));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d_box, seen, bits);
    out.seen |= (static_cast<std::uint32_t>(bits[0]) | static_cast<std::uint32_t>(bits[1]) << 8U)
                << i;
  }
}

}  // namespace
}  // namespace viewgain::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
