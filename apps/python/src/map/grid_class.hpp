// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "shared_grid.hpp"

namespace viewgain::python {

using GridClass = pybind11::class_<SharedGrid, std::shared_ptr<SharedGrid>>;

/// Adds reading and writing of files.
void bind_grid_files(GridClass& grid_class);
/// Adds what is about single voxels.
void bind_voxels(GridClass& grid_class);

}  // namespace viewgain::python
