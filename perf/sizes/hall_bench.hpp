// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::bench {

inline const Box kHallWorkspace{{-10, -10, 0}, {10, 10, 3}};
/// Tables, shelves and crates next to the aisles, on the floor and at all heights.
[[nodiscard]] TriangleMesh hall_mesh();
/// Pose of the camera at a frame. It goes up one aisle and down the next, looking left and right.
[[nodiscard]] Pose hall_pose(int frame, int frames);

struct HallOptions {
  int num_threads = 0;  ///< 0: all hardware threads
  double voxel = 0.01;  ///< [m]
  int coarsest = 0;     ///< IntegrationConfig::coarsest
  int frames = 1000;
  int poses = 200;
  bool json = false;
};

/// Measures memory and speed of a large map: a hall of 20 m × 20 m × 3 m with tables, shelves and
/// crates. A kinect_v1 (640×480, noise on) moves along the aisles, with a frame every 0.11 m if
/// there are 1,000.
///
/// Times the integration of each frame, and building and updating the scene. Scores poses_in() the
/// hall by the gain paper. Forgets half of the map. The peak is VmHWM minus VmRSS before the grid
/// was made: map, scene, evaluator and all temporaries, with those of the simulation. Returns the
/// exit code.
int run_hall(const HallOptions& options);

}  // namespace viewgain::bench
