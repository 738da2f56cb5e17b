// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "readings.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// Local surfaces at a row's adjacent pixels, as many as a vector has lanes.
struct LocalSurfaces {
  static constexpr std::size_t kMost = 8;
  std::array<bool, kMost> found{};
  std::array<double, kMost> x{}, y{}, z{};  ///< the moved readings [m]
};

/// Moves readings along the normal onto the surface of the surrounding pixels. This surface is the
/// least-squares plane of depth over the image. It is fitted to those of the 5×5 pixels whose depth
/// differs from the pixel's by at most a slope of 2 plus noise. No place is found if:
/// - the pixel has no reading
/// - fewer than 6 of the 5×5 pixels remain, or they are collinear
/// - the cosine of the angle of incidence is below kMinCosIncidence
/// - the reading is more than 3 sigma from the plane, and so belongs to another surface
///
/// One set of functions per instruction set. All give the same bits, as BlockKernels do.
struct SurfaceKernels {
  int lanes;  ///< pixels of group()
  void (*group)(const Readings& readings, int u, int v, LocalSurfaces& surfaces);
  void (*one)(const Readings& readings, int u, int v, LocalSurfaces& surfaces);

  /// Finds the surfaces at pixels from `u` of row v on. Returns the pixel of the first, which can
  /// lie before u, and their number.
  std::array<int, 2> find(const Readings& readings, int u, int v, LocalSurfaces& surfaces) const {
    const int width = readings.row_length();
    if (width < lanes) {
      one(readings, u, v, surfaces);
      return {u, 1};
    }
    const int first = u + lanes <= width ? u : width - lanes;
    group(readings, first, v, surfaces);
    return {first, lanes};
  }
};

[[nodiscard]] const SurfaceKernels& surface_kernels(Isa isa);

}  // namespace viewgain::detail
