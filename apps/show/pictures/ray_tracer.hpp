// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "show/pictures/painted_mesh.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/formats/png.hpp"

namespace viewgain::app {

/// Renders with Embree: one sun with shadows, a sky with ambient occlusion up to `occlusion_range`
/// [m], 2x2 samples a pixel. The same picture for any number of threads.
[[nodiscard]] RgbImage render(const PaintedMesh& scene, const PinholeCamera& camera,
                              const Pose& T_world_camera, double occlusion_range,
                              const ExecConfig& exec);

}  // namespace viewgain::app
