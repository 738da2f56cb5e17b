// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <octomap/OcTree.h>

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "oracle/dense_map.hpp"

namespace viewgain::bench {

/// Both lattices pass through the origin: voxel i has the key i + 2^15 on each axis.
inline constexpr int kOctomapKeyOffset = 1 << 15;

[[nodiscard]] octomap::OcTreeKey key_of(Index3 voxel);
[[nodiscard]] Index3 voxel_of(const octomap::OcTreeKey& key);

/// Converts to OctoMap's single precision.
[[nodiscard]] octomap::point3d octomap_point(const Eigen::Vector3d& p);

/// An empty tree with the update rule of BeliefGrid: +0.85, -0.4, clamped to -2..3.5.
[[nodiscard]] std::unique_ptr<octomap::OcTree> empty_octree(double voxel_size);

/// A pruned tree of the map's known voxels. Unknown voxels have no node. T_world_grid must be the
/// identity.
[[nodiscard]] std::unique_ptr<octomap::OcTree> octree_of(const oracle::DenseMap& map);

/// The part of the segment from `from` to `to` [m, grid frame] inside the workspace, or nothing. It
/// keeps 1e-5 voxel from the faces, because OctoMap's coordinates have single precision. `leaves`
/// is true if the segment ends outside.
struct ClippedSegment {
  Eigen::Vector3d begin;
  Eigen::Vector3d end;
  bool leaves = false;
};
[[nodiscard]] std::optional<ClippedSegment> clip_to_workspace(const oracle::DenseMap& map,
                                                              const Eigen::Vector3d& from,
                                                              const Eigen::Vector3d& to);

}  // namespace viewgain::bench
