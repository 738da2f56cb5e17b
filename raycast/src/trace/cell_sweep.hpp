// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "image_bounds.hpp"
#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "strip_rays.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// A cell and the rays that can meet it.
struct SeenCell {
  std::uint32_t cell;
  float near;  ///< where it begins along the optical axis [voxels]
  ImageRect rect;
};

/// Traces the rays of a strip that have not ended through the primitives of a cell, from near to
/// far. Rays end there unless the cell has no place in the order. `camera_block`: the camera's, on
/// the lattice of 8³ voxels. The same bits for every instruction set.
using CellSweep = void (*)(const SceneData& scene, const SeenCell& cell, const PoseFrame& frame,
                           const ImageScale& image, const std::array<std::int32_t, 3>& camera_block,
                           StripRays& strip);

/// That of an instruction set that the CPU supports.
[[nodiscard]] CellSweep cell_sweep(Isa isa);

}  // namespace viewgain::detail
