// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Everything of the library but mesh/: core, grid, raycast.

#include "viewgain/core/box.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/covariance.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/core/noise.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/raycast/voxel_scene.hpp"
