// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::python {

/// Python's VoxelScene. Not the scene itself, because pybind11 holds no pointers to const.
struct Scene {
  std::shared_ptr<const VoxelScene> scene;
};

}  // namespace viewgain::python
