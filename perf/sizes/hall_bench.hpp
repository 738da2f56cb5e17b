// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::bench {

inline const Box kHallWorkspace{{-10, -10, 0}, {10, 10, 3}};
/// Tables, shelves and crates on the floor and at all heights, beside the aisles.
[[nodiscard]] TriangleMesh hall_mesh();
/// Up one aisle and down the next, looking left and right: where the camera is at a frame.
[[nodiscard]] Pose hall_pose(int frame, int frames);

struct HallOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  double voxel = 0.01;  ///< [m]
  int coarsest = 0;     ///< IntegrationConfig::coarsest
  int frames = 1000;
  int poses = 200;
  bool json = false;
};

/// Memory and speed of a large map: a hall of 20 m × 20 m × 3 m with tables, shelves and crates,
/// through which a kinect_v1 (640×480, noise on) is carried along the aisles, a frame every 0.11 m
/// if there are 1,000. Times each frame's integration and the scene's build and update, scores
/// poses_in() the hall by the paper's gain, forgets half of the map. The peak is VmHWM less VmRSS
/// from before the grid: map, scene, evaluator and all temporaries, those of the simulation
/// included. Returns the exit code.
int run_hall(const HallOptions& options);

}  // namespace viewgain::bench
