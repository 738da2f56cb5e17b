// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "octomap_tree.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::bench {

/// Adds a depth frame to an octree like FrameIntegrator with lines, on one thread. Rays are clipped
/// to the workspace, which `frame_of` defines. computeRayKeys fills a KeySet of free cells and one
/// of hit cells. Hits take precedence over crossings. Nodes are updated lazily, followed by one
/// updateInnerOccupancy.
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
