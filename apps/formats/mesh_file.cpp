// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh_file.hpp"

#include "viewgain/core/error.hpp"

namespace viewgain::app {

TriangleMesh load_mesh(const std::filesystem::path& path, const MeshPlacement& placement) {
  TriangleMesh mesh = read_mesh(path);
  try {
    return placed(std::move(mesh), placement);
  } catch (const Error& error) {
    throw Error(error.code(), path.string() + ": " + error.what());
  }
}

}  // namespace viewgain::app
