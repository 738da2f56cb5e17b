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

/// Side of the voxels that the object is made of in their simulations [m].
inline constexpr double kTruthVoxel = 0.002;

/// The camera of NBV-Simulation and MA-SCVP, 640x480, as their code reads its lens: a polynomial
/// from pixels to rays, where ours goes from rays to pixels. k1 k2 p1 p2 k3 of ours are fitted to
/// its inverse by least squares over the image. Noise: what voxels of 2 mm leave, 2 mm / √12 in
/// each direction. `working_distance` and `max_range` in [m].
[[nodiscard]] Sensor peer_sensor(double working_distance, double max_range);

/// How far, at most, a pixel of that sensor is from where their polynomial has it [px].
[[nodiscard]] double peer_lens_error(const Sensor& sensor);

/// What a camera sees of the truth.
struct VoxelFrame {
  DepthFrame depth;                        ///< of the centres of the voxels that are hit
  std::vector<octomap::OcTreeKey> voxels;  ///< those, each once
};

/// An object as voxels that points lie in, and their noise-free camera: octomap's castRay from the
/// centre of the voxel that holds the camera, through the pixel's point at a depth of 1 m, to
/// max_range. A pixel that hits nothing is invalid.
class VoxelTruth {
 public:
  VoxelTruth(const std::vector<Eigen::Vector3d>& points, const Sensor& sensor);

  /// On the pool's threads; the same for any number of them.
  [[nodiscard]] VoxelFrame acquire(const Pose& T_world_camera, ThreadPool& pool) const;

  [[nodiscard]] octomap::point3d center_of(const octomap::OcTreeKey& voxel) const {
    return tree_.keyToCoord(voxel);
  }
  /// The voxel that holds a point of the world [m].
  [[nodiscard]] octomap::OcTreeKey voxel_of(const Eigen::Vector3d& p_world) const;

 private:
  Sensor sensor_;
  std::vector<Eigen::Vector3d> directions_;  ///< (x, y, 1), camera frame
  octomap::OcTree tree_;
  Eigen::Vector3d low_;   ///< of a box that holds the voxels, with one to spare [m]
  Eigen::Vector3d high_;  ///< [m]
};

}  // namespace viewgain::bench
