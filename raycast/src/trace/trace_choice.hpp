// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "scene/scene_cells.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/isa.hpp"

namespace viewgain::detail {

/// How scenes and views are traced is decided here and nowhere else. All ways give the same bits.
///
/// - Sweeping: the scene's primitives from near to far, each with the rays that can meet it and
/// have
///   not ended yet.
/// - Embree's BVH, if the environment variable VIEWGAIN_TRACE says `bvh`.
///
/// Known obstacles are triangles and always traced by Embree, where they can end a ray.

enum class TraceWay : std::uint8_t { sweep, bvh };

/// What VIEWGAIN_TRACE says, sweep if it is not set. Throws Error(invalid_argument) for another
/// value.
[[nodiscard]] TraceWay wished_way();

/// The best instruction set, within VIEWGAIN_ISA, for which Embree has packets of the kernels'
/// width. Throws Error(backend) if there is none, Error(invalid_argument) as select_isa().
[[nodiscard]] Isa choose_isa();

/// The margin by which boxes count as larger [voxels], so that rounding hides none from a ray that
/// the kernels let into it: by halvings and doublings of the coordinates that single precision has
/// to hold. Level 0 holds up to 2e4 voxels.
inline constexpr int kMarginLevels = 9;
[[nodiscard]] int choose_margin_level(double reach);
[[nodiscard]] inline float margin_of(int level) {
  return kBoxMargin * static_cast<float>(1 << level);
}

/// How the views of one sensor are traced in one scene.
struct ViewChoice {
  bool by_sweep = false;
  int margin_level = 0;
};
/// `max_range` in voxels.
[[nodiscard]] ViewChoice choose_tracing(const SceneData& scene, TraceWay way, double max_range);

}  // namespace viewgain::detail
