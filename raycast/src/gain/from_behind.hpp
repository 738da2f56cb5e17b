// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace viewgain::detail {

/// When a ray comes to known surface from behind, and what the surface in between counts for
/// (apps/docs/guide/surface_gain.md, "From behind"). That surface is new, since it faces the ray,
/// and is taken to be parallel to what is known.
struct FromBehind {
  /// So much unknown space lies right before the known surface [voxels], or more.
  static constexpr float kLeastStretch = 2.0F;
  /// The ray and the outward normal have a larger cosine.
  static constexpr float kLeastCosine = 0.2F;

  /// Area of that surface over its area across the ray. Where it is seen at a slant of more than
  /// 70° few readings make points.
  [[nodiscard]] static double area_over_across(double cosine) { return 1 / std::max(cosine, 0.35); }
};

}  // namespace viewgain::detail
