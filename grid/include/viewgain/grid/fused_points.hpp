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
  SymmetricMatrix3 covariance{};     ///< covariance, including FusedPointsConfig::floor_sigma [m²]
  std::array<double, 3> toward_free{};  ///< unit surface normal towards free space
  std::uint32_t hits = 0;               ///< number of readings that support it
  double spacing = 0;  ///< distance of neighbouring points: the pooling length of the leaf [m]
};

/// Settings of fused_points(). Lengths are in pooling lengths unless stated otherwise. A pooling
/// length is the voxel size or the footprint of a pixel on the surface, whichever is larger
/// (pooling_of()).
struct VIEWGAIN_EXPORT FusedPointsConfig {
  /// False: pools the beliefs in a short column of voxels along the surface normal into one point,
  /// because noise spreads readings of the same surface over several voxels. True: makes one point
  /// per occupied voxel, at the weighted mean of its readings, as in Foix et al. (2012). This mean
  /// is the voxel's centre + Λ_v⁻¹ η_v, with Λ_v and η_v from its Belief.
  bool per_voxel = false;
  std::uint32_t min_hits = 2;  ///< points with fewer readings are omitted
  /// Omits points with little evidence, such as the halo at silhouettes. The evidence of a point is
  /// its number of readings, divided by the number that one frontal view at the same range would
  /// give. Surface that was seen from afar is therefore kept.
  ///
  /// A point is omitted if its evidence is below this fraction of the upper quartile among its
  /// neighbours. Neighbours are the points within 4 pooling lengths whose normals differ by less
  /// than 60°. The less seen side of a thin wall is therefore kept. 0 keeps all points.
  double min_relative_evidence = 0.25;
  double normal_radius = 5.0;  ///< radius of the ball whose beliefs give the surface normal, at
                               ///< most 8 [pooling lengths]
  double column_radius = 1.0;  ///< radius of the pooled column [pooling lengths]
  /// Half height of the column, in standard deviations of one reading along the normal.
  double column_sigmas = 1.75;
  /// Minimum distance between pooled points whose normals differ by less than 90° [pooling
  /// lengths]; 0 keeps all. A point at 0.4 lengths or more is kept if its removal would leave a
  /// hole. Rare small gaps remain.
  double min_distance = 0.75;
  /// Square root of F [m], a variance that is added in all directions. It stands for errors that a
  /// point's readings share, and for blur from pooling. Default: F = edge² / 12 with per_voxel,
  /// otherwise F = min(1, 0.2 + 2 / e) · ((0.19 σ)² + (0.43 s)² + (0.02 edge)²).
  /// - e: evidence of the point, see min_relative_evidence
  /// - σ: standard deviation of one reading along the normal [m]
  /// - s: standard deviation of the voxels' mean readings in the column, along the normal [m]
  /// - edge: edge length of the voxels, or of the cubes in which they are pooled [m]
  std::optional<double> floor_sigma{};
  /// Sensor::scale_sigma of the camera. A scale error moves all readings of a point together, so
  /// scale_sigma² w wᵀ is added to the point's covariance. w [m] is the mean vector from the views
  /// to the point. Only views on the point's free side count, each with an estimate of its number
  /// of readings as the weight. Occlusion is ignored. Without such views nothing is added.
  double scale_sigma = 0;
  /// Makes points only from voxels (or pooled cubes) whose centre [m, world frame] satisfies this
  /// predicate. If it is empty, all voxels are used. Near the border of the selection, points can
  /// differ from those of the whole map.
  std::function<bool(const Eigen::Vector3d&)> where{};
};

/// Surface points of a map, with covariances. A pooled point starts at an occupied voxel or cube of
/// voxels (pooling_of()). Along the local normal, it moves to the mean of all readings in its
/// column. Readings in voxels that have since become free are included. The point's covariance is
/// that of the mean, plus the terms of floor_sigma and scale_sigma. Both sides of a thin wall are
/// kept; min_distance thins out redundant points. grid/README.md ("Surface points") has the
/// details.
///
/// In a map with cells of several sizes (BeliefGrid::scale()), the cells of each size are pooled
/// separately. Points from the smallest cells come first. Within a size, points are ordered by the
/// voxel or cube that they start from. Deterministic for any number of threads. Cost per voxel that
/// was ever hit: about 1 µs if config.where accepts it, otherwise 0.3 µs. Throws
/// Error(invalid_argument) naming a setting that is negative, not finite or too large.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<FusedPoint> fused_points(
    const BeliefGrid& grid, const FusedPointsConfig& config = {}, const ExecConfig& exec = {});

/// The length over which readings of the same surface are combined. A voxel that is finer than the
/// footprint of a pixel holds too few readings, however often its surface was seen.
struct VIEWGAIN_EXPORT Pooling {
  int shift = 0;      ///< beliefs are summed in cubes of 2^shift voxels per edge, at most 3
  double length = 0;  ///< edge of the cubes or the footprint, whichever is longer [m]
};

/// Pooling of a map. The footprint is the standard deviation of a reading across its ray. It is
/// estimated from the beliefs, as the median over the occupied voxels. The edge of the cubes is as
/// large as possible below 1.42 footprints; if voxels are larger than that, shift is 0. If `scale`
/// (0 to 3) is given, only leaves with this scale (BeliefGrid::scale()) are considered, and the
/// cubes are at least as large as the cells of these leaves. Never throws. Thread safe. Cost: about
/// 20 ns per occupied voxel.
[[nodiscard]] VIEWGAIN_EXPORT Pooling pooling_of(const GridSnapshot& snapshot,
                                                 std::optional<int> scale = {});

}  // namespace viewgain
