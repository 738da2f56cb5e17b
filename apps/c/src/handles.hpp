// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the opaque handles of viewgain.h are. Scenes are shared by what is made from them, so
// handles may go in any order.

#include <cstddef>
#include <memory>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
#include "viewgain/viewgain.h"

struct vg_grid {
  viewgain::BeliefGrid grid;
};

struct vg_integrator {
  viewgain::FrameIntegrator integrator;
  viewgain::HazardCalibration calibration;
  int width, height;  // of its frames [px]

  /// `amplitude` may be null.
  [[nodiscard]] viewgain::DepthFrame frame(const float* depth, const float* amplitude) const {
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    viewgain::DepthFrame result;
    result.width = width;
    result.height = height;
    result.depth.assign(depth, depth + count);
    if (amplitude != nullptr) result.amplitude.assign(amplitude, amplitude + count);
    return result;
  }
};

struct vg_scene {
  std::shared_ptr<const viewgain::VoxelScene> scene;
};

struct vg_evaluator {
  viewgain::GainEvaluator evaluator;
};

struct vg_feasibility {
  viewgain::FeasibilityChecker checker;
};
