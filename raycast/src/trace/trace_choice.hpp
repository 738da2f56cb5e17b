// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "scene/scene_boxes.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/isa.hpp"

namespace viewgain::detail {

/// How scenes and views are traced is decided here and nowhere else. All ways give the same bits.
///
/// - Lists of what each tile of a view can meet, made by sorting the scene's boxes into the tiles.
///   Of many primitives, cells are sorted first, and the primitives of a cell when a tile comes to
///   it.
/// - Embree's BVH, if the environment variable VIEWGAIN_TRACE says `bvh`.
///
/// Known obstacles are triangles and always traced by Embree, where they can end a ray.

enum class TraceWay : std::uint8_t { lists, bvh };

/// What VIEWGAIN_TRACE says, lists if it is not set. Throws Error(invalid_argument) for another
/// value.
[[nodiscard]] TraceWay wished_way();

/// The best instruction set, within VIEWGAIN_ISA, for which Embree has packets of the kernels'
/// width. Throws Error(backend) if there is none, Error(invalid_argument) as select_isa().
[[nodiscard]] Isa choose_isa();

/// What a scene of so many primitives sorts into the tiles of a view.
[[nodiscard]] SceneBoxes::Kind choose_boxes(std::size_t primitive_count);

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
  bool by_lists = false;
  int margin_level = 0;
};
/// `max_range` in voxels.
[[nodiscard]] ViewChoice choose_tracing(const SceneData& scene, TraceWay way, double max_range);

}  // namespace viewgain::detail
