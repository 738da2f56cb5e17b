// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Outlines of boxes in the image, compiled once for each instruction set.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/image_bounds.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
//
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "image_bounds-inl.hpp"
#include "image_bounds.hpp"
#include "viewgain/support/isa_dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace viewgain::detail::HWY_NAMESPACE {

const ImageBoundsKernels& image_bounds_of_target() {
  static const ImageBoundsKernels table{
      [](const BoxArrays& boxes, std::size_t first, const PoseFrame& frame, const ImageScale& image,
         ImageBounds& out) HWY_ATTR { bounds_of(boxes, first, frame, image, out); }};
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
  return VIEWGAIN_OF_ISA(isa, image_bounds_of_target)();
}

}  // namespace viewgain::detail
#endif
