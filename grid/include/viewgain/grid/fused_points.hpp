// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "viewgain/core/covariance.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/grid_snapshot.hpp"

namespace viewgain {

/// A surface point of the map, world frame.
struct VIEWGAIN_EXPORT FusedPoint {
  std::array<double, 3> position{};  ///< [m]
  SymmetricMatrix3 covariance{};     ///< covariance [m²], including FusedPointsConfig::floor_sigma
  std::array<double, 3> toward_free{};  ///< unit surface normal towards free space
  std::uint32_t hits = 0;               ///< number of readings (measured depths) that support it
  double spacing = 0;  ///< typical distance to the next points: the pooling length [m]
};

/// Settings of fused_points(). The belief of a voxel is defined in grid/belief.hpp. The footprint
/// is the width of a pixel on the surface. A pooling length is the voxel size or the footprint,
/// whichever is larger (pooling_of()).
struct VIEWGAIN_EXPORT FusedPointsConfig {
  /// False: makes each point from the beliefs in a short column of voxels along the surface normal,
  /// because noise spreads readings of one surface over several voxels. True: makes one point per
  /// occupied voxel, at the weighted mean of its readings, as in Foix et al. (2012). This mean is
  /// the voxel's centre + Λ_v⁻¹ η_v.
  bool per_voxel = false;
  std::uint32_t min_hits = 2;  ///< omits points with fewer readings
  /// Omits points with little evidence, such as the halo at silhouettes. The evidence of a point is
  /// its number of readings, divided by the number that one frontal view at the same range would
  /// give. The division keeps surface that was seen from afar.
  ///
  /// A point is omitted if its evidence is below this fraction of the upper quartile among its
  /// neighbours. 0 keeps all points. Neighbours are points within 4 pooling lengths whose normals
  /// differ by less than 60°. Points on the other side of a thin wall are therefore not neighbours.
  double min_relative_evidence = 0.25;
  /// Radius of the ball whose beliefs give the surface normal, at most 8 [pooling lengths].
  double normal_radius = 5.0;
  double column_radius = 1.0;  ///< radius of the pooled column [pooling lengths]
  /// Half height of the column [standard deviations of one reading along the normal].
  double column_sigmas = 1.75;
  /// Minimum distance between points whose normals differ by less than 90° [pooling lengths]; 0
  /// keeps all. Only with per_voxel false. If the removal of a point would leave a hole, the
  /// minimum is 0.4 pooling lengths. Rare small gaps remain.
  double min_distance = 0.75;
  /// Standard deviation √F of an isotropic error [m]: F times the identity matrix is added to the
  /// covariance of each point. It covers errors that a point's readings share, and blur from
  /// pooling. Default with per_voxel: F = edge² / 12. Default otherwise: F = min(1, 0.2 + 2 / e) ·
  /// ((0.19 σ)² + (0.43 s)² + (0.02 edge)²).
  /// - e: evidence of the point, see min_relative_evidence
  /// - σ: standard deviation of one reading along the normal [m]
  /// - s: standard deviation of the voxels' mean readings in the column, along the normal [m]
  /// - edge: edge length of the voxels, or of the cubes in which they are pooled [m]
  std::optional<double> floor_sigma{};
  /// Sensor::scale_sigma of the camera. A scale error moves all readings of a point together, so
  /// scale_sigma² w wᵀ is added to the point's covariance. w [m] is the mean vector from the views
  /// to the point, weighted by the estimated number of readings per view. Views behind the surface
  /// are omitted, and occlusion is ignored. If there are no views, nothing is added.
  double scale_sigma = 0;
  /// Predicate that restricts the points: a voxel (or pooled cube) gives a point only if its centre
  /// [m, world frame] satisfies the predicate. Empty: no restriction. Near the border of the
  /// selection, points can differ from those of the whole map.
  std::function<bool(const Eigen::Vector3d&)> where{};
};

/// Surface points of a map, with covariances. A point starts at the centre of an occupied voxel or
/// cube of voxels (pooling_of()). It then moves along the local normal to the mean of all readings
/// in its column, including readings in voxels that are free by now. The point's covariance is that
/// of this mean, plus the terms of floor_sigma and scale_sigma. grid/README.md ("Surface points")
/// has the details.
///
/// In a map with cells of several sizes (BeliefGrid::scale()), the cells of each size are pooled
/// separately. Points from the smallest cells come first. Within a size, points are ordered by the
/// voxel or cube that they start from. Deterministic for any number of threads. Throws
/// Error(invalid_argument), naming the setting, if a setting is negative, not finite or too large.
/// Cost per voxel that was ever hit: about 1 µs if config.where accepts it, otherwise 0.3 µs.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<FusedPoint> fused_points(
    const BeliefGrid& grid, const FusedPointsConfig& config = {}, const ExecConfig& exec = {});

/// The length over which readings of one surface are combined into a point. This is needed because
/// voxels smaller than the footprint of a pixel contain too few readings.
struct VIEWGAIN_EXPORT Pooling {
  int shift = 0;      ///< beliefs are summed in cubes of 2^shift voxels per edge; at most 3
  double length = 0;  ///< edge of the cubes or the footprint, whichever is larger [m]
};

/// Pooling of a map. The footprint is estimated from the beliefs: it is the standard deviation of a
/// reading across its ray, as a median over the occupied voxels. The cubes are as large as possible
/// with an edge below 1.42 footprints. If single voxels are larger than that, shift is 0. If
/// `scale` (0 to 3) is given, considers only leaves with this scale (BeliefGrid::scale()), and
/// makes the cubes at least as large as their cells. Never throws. Thread safe. Cost: about 20 ns
/// per occupied voxel.
[[nodiscard]] VIEWGAIN_EXPORT Pooling pooling_of(const GridSnapshot& snapshot,
                                                 std::optional<int> scale = {});

}  // namespace viewgain
