// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"

namespace viewgain::test {

/// camel.off as the build took it out of Debian's libcgal-demo.
[[nodiscard]] std::filesystem::path camel_mesh_path();

/// The camel as all benchmarks place it: 0.35 m long, centred at the origin.
[[nodiscard]] TriangleMesh camel_mesh(const std::filesystem::path& path = camel_mesh_path());

/// One noise-free frame and where it was taken.
struct CamelView {
  Pose T_world_camera;
  DepthFrame frame;
};

/// Noise-free SR4000 views at azimuths 0°, 46°, 92°, ... in front of the 1.5 m background; the
/// first three make camel-N.
[[nodiscard]] std::vector<CamelView> camel_views(
    std::size_t count = 3, const std::filesystem::path& path = camel_mesh_path());

/// camel-N without its views: all unknown, N³ voxels in [-0.2, 0.2]³ m.
[[nodiscard]] BeliefGrid empty_camel_grid(int voxels_per_side);

/// camel-N from the views given.
[[nodiscard]] BeliefGrid camel_grid(int voxels_per_side, const std::vector<CamelView>& views,
                                    const IntegrationConfig& config = {});

/// camel-N.
[[nodiscard]] BeliefGrid camel_grid(int voxels_per_side,
                                    const std::filesystem::path& path = camel_mesh_path());

}  // namespace viewgain::test
