// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace viewgain::detail {

/// Whether Embree traces views of so many rays faster than the sweep, once it has a BVH
/// (perf/results/tracers.md).
[[nodiscard]] constexpr bool bvh_is_faster(std::size_t rays, std::size_t primitives) {
  return rays <= std::max<std::size_t>(100, primitives / 50);
}

/// Whether a BVH pays for what it takes to build, if as many such views follow as there were.
[[nodiscard]] constexpr bool bvh_pays(std::size_t primitives, std::uint64_t views) {
  return views >= std::min<std::size_t>(primitives / 5, 3000);
}

}  // namespace viewgain::detail
