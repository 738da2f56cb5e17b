// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// What becomes of a view's rays, for asking why its gain is what it is. Each ray counts once, so
/// that the counts below `rays` add up to it.
struct VIEWGAIN_EXPORT RayOutcomes {
  std::uint32_t rays = 0;           ///< of the view
  std::uint32_t too_near = 0;       ///< meet surface or an obstacle before min_range, in free space
  std::uint32_t unknown = 0;        ///< come to unknown space: what may be new
  std::uint32_t known_surface = 0;  ///< end in known surface, with free space before it
  std::uint32_t obstacle =
      0;  ///< end at an obstacle or, but by the paper's gain, on the support plane
  std::uint32_t out_of_range = 0;  ///< are in known free space to max_range
  std::uint32_t out_of_map = 0;    ///< leave the workspace, or never come into it
};

}  // namespace viewgain
