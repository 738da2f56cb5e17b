// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace viewgain::bench {

/// NBV-Simulation's measure of progress: an OctoMap of 1 cm, hit 0.7, miss 0.4. The box around the
/// object starts at p = 0.5. Each view adds a scan with OctoMap's insertPointCloud. Voxels in the
/// box with p > 0.65 count. A voxel that is hit by one scan and passed by another falls to 0.61, so
/// the count can fall.
class PeerMap {
 public:
  static constexpr double kVoxel = 0.01;          ///< [m]
  static constexpr double kOccupiedAbove = 0.65;  ///< probability

  /// The box is center ± size [m].
  PeerMap(const Eigen::Vector3d& center, double size);

  /// Adds a scan: the ends of its rays and the camera's position [m].
  void insert(std::span<const octomap::point3d> hits, const Eigen::Vector3d& eye);

  [[nodiscard]] std::size_t occupied() const;

  /// The number of voxels of 1 cm with a point of the complete model. occupied() is divided by it.
  [[nodiscard]] static std::size_t voxels_of(const std::vector<Eigen::Vector3d>& points);

 private:
  Eigen::Vector3d low_;   ///< [m]
  Eigen::Vector3d high_;  ///< [m]
  octomap::OcTree tree_;
};

}  // namespace viewgain::bench
