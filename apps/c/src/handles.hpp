// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the opaque handles of viewgain.h are. Scenes are shared by what is made from them, so
// handles may go in any order.

#include <memory>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/range_calibration.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/hazard_calibration.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/raycast/feasibility.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
#include "viewgain/viewgain.h"

struct vg_range_calibration {
  viewgain::RangeCorrector corrector;
};

struct vg_grid {
  viewgain::BeliefGrid grid;
};

struct vg_integrator {
  viewgain::FrameIntegrator integrator;
  viewgain::HazardCalibration calibration;
  viewgain::PinholeCamera camera;  // of its frames
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
