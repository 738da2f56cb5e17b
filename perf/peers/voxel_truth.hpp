// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Core>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {

/// Side of the object's voxels in their simulations [m].
inline constexpr double kTruthVoxel = 0.002;

/// The camera of NBV-Simulation and MA-SCVP, 640x480. Their lens is a polynomial from pixels to
/// rays; ours goes from rays to pixels. Our k1 k2 p1 p2 k3 are fitted to the inverse by least
/// squares over the image. Noise is that of voxels of 2 mm: 2 mm / √12 in each direction.
/// `working_distance` and `max_range` are in metres.
[[nodiscard]] Sensor peer_sensor(double working_distance, double max_range);

/// The maximum distance of a pixel of that sensor from its place in their polynomial [px].
[[nodiscard]] double peer_lens_error(const Sensor& sensor);

/// A frame of the true voxels.
struct VoxelFrame {
  DepthFrame depth;                        ///< depth of the centres of the voxels that are hit
  std::vector<octomap::OcTreeKey> voxels;  ///< the voxels that are hit, each once
};

/// An object as the voxels that contain its points, with their noise-free camera. octomap's castRay
/// goes from the centre of the camera's voxel through the pixel's point at a depth of 1 m, up to
/// max_range. A pixel that hits nothing is invalid.
class VoxelTruth {
 public:
  VoxelTruth(const std::vector<Eigen::Vector3d>& points, const Sensor& sensor);

  /// Runs on the pool's threads. The result does not depend on their number.
  [[nodiscard]] VoxelFrame acquire(const Pose& T_world_camera, ThreadPool& pool) const;

  [[nodiscard]] octomap::point3d center_of(const octomap::OcTreeKey& voxel) const {
    return tree_.keyToCoord(voxel);
  }
  /// The voxel that contains a point in the world frame [m].
  [[nodiscard]] octomap::OcTreeKey voxel_of(const Eigen::Vector3d& p_world) const;

 private:
  Sensor sensor_;
  std::vector<Eigen::Vector3d> directions_;  ///< (x, y, 1), camera frame
  octomap::OcTree tree_;
  Eigen::Vector3d low_;   ///< of a box around the voxels, with a margin of one [m]
  Eigen::Vector3d high_;  ///< [m]
};

}  // namespace viewgain::bench
