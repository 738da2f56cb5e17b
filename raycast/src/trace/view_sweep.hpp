// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cell_sweep.hpp"
#include "image_bounds.hpp"
#include "obstacle_marks.hpp"
#include "scene/scene_cells.hpp"
#include "strip_rays.hpp"

namespace viewgain::detail {

/// What a thread needs to sweep views of any scene and sensor, one after another.
struct ViewSweep {
  std::vector<SeenCell> seen;  ///< cells that reach out of their nodes, then from near to far
  std::array<std::int32_t, 3> camera_block{};  ///< on the lattice of 8³ voxels
  ObstacleMarks obstacles;
  StripRays strip;

  /// Finds the cells that a view sees. Allocates only while it grows.
  void see(const ImageBoundsKernels& kernels, const SceneCells& cells, const PoseFrame& frame,
           const ImageScale& image);

 private:
  std::vector<SeenCell> found_;
  std::vector<std::uint32_t> keys_, begins_;
};

}  // namespace viewgain::detail
