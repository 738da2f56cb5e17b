// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

#include "oracle/dense_map.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::oracle {

/// A ray in the grid's frame, in units of voxels; the direction has unit length.
struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/// What bounds a ray, along it [voxel].
struct RayLimits {
  double min_range = 0;
  double max_range = std::numeric_limits<double>::infinity();
  double obstacle_range =
      std::numeric_limits<double>::infinity();  ///< where a known obstacle blocks
};

/// Calls visit(voxel, t_in, t_out) for the voxels of the workspace that the ray visits for a
/// positive length, in order, t in voxels; ends when visit returns true.
void walk(const DenseMap& map, const Ray& ray,
          const std::function<bool(Index3, double, double)>& visit);

/// Whether a visit that begins at t ends the ray before it measures: a known surface that it enters
/// before min_range. The voxel that the ray starts in does not.
[[nodiscard]] bool blocks(const DenseMap& map, const Ray& ray, const RayLimits& limits,
                          Index3 voxel, double t);

/// The first voxel that is not free, whose visit ends beyond min_range and begins at or before
/// max_range and before the obstacle; or the obstacle; or nothing. Known surface before min_range
/// blocks as an obstacle does. Range in [m].
[[nodiscard]] RayHit first_hit(const DenseMap& map, const Ray& ray, const RayLimits& limits);

/// Whether `tested` can be where the ray ends if the ray or its range limits are moved by at most
/// `tolerance` voxels: one of a few hundred rays so close must end exactly there. They are rings of
/// parallel rays, limits a little nearer or farther, and all of those again with the edges and
/// corners that they cut off by a visit of at most `tolerance` passed exactly, where such a visit
/// has no length. Nothing of this takes a ray through a wall, not even along the seam of two
/// voxels: a leak is no tie.
[[nodiscard]] bool is_tie(const DenseMap& map, const Ray& ray, const RayLimits& limits,
                          const RayHit& tested, double tolerance = 1e-4);

/// Whether the point at the tested range lies on the tested voxel's surface within `tolerance`
/// voxels, or inside it where the ray starts there or min_range ends there.
[[nodiscard]] bool range_is_entry(const DenseMap& map, const Ray& ray, const RayLimits& limits,
                                  const RayHit& tested, double tolerance = 1e-4);

/// Same kind of ending and, for voxels, the same voxel.
[[nodiscard]] bool same_ending(const RayHit& a, const RayHit& b);

}  // namespace viewgain::oracle
