// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::python {

/// Python's VoxelScene. Not the scene itself, because pybind11 holds no pointers to const.
struct Scene {
  std::shared_ptr<const VoxelScene> scene;
};

/// Obstacles from (n, 2, 3) boxes or None, and pairs (vertices, triangles).
[[nodiscard]] Obstacles obstacles_of(const pybind11::object& boxes,
                                     const pybind11::iterable& meshes);

}  // namespace viewgain::python
