// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "octomap_tree.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::bench {

/// Puts a depth frame into an octree the way FrameIntegrator does with lines, on one thread: rays
/// clipped to the workspace, computeRayKeys, a KeySet of free and one of hit cells, hits before
/// crossings, lazy updateNode and one updateInnerOccupancy. `frame_of` gives the workspace.
class OctomapIntegrator {
 public:
  OctomapIntegrator(const Sensor& sensor, const oracle::DenseMap& frame_of);

  void integrate(octomap::OcTree& tree, const DepthFrame& frame, const Pose& T_world_camera);

 private:
  const oracle::DenseMap& map_;
  double min_range_;                         ///< [m]
  double max_range_;                         ///< [m]
  std::vector<Eigen::Vector3d> directions_;  ///< (x, y, 1), camera frame
  octomap::KeyRay ray_;
};

}  // namespace viewgain::bench
