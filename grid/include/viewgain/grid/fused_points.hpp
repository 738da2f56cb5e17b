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
  std::array<double, 3> position{};     ///< [m]
  SymmetricMatrix3 covariance{};        ///< covariance of the position, including the floor F [m²]
  std::array<double, 3> toward_free{};  ///< unit surface normal towards free space
  std::uint32_t hits = 0;               ///< number of readings that support it
  double spacing = 0;  ///< spacing of points of its leaf's scale: the pooling length [m]
};

/// Lengths are in pooling lengths unless stated otherwise: the voxel size or the sensor's
/// footprint, whichever is larger (pooling_of).
struct VIEWGAIN_EXPORT FusedPointsConfig {
  /// False: fuses the beliefs of a short column of voxels along the surface normal into one point,
  /// because noise spreads readings of one place over several voxels. True: makes each occupied
  /// voxel a point, centre + Λ_v⁻¹ η_v, as the paper does.
  bool per_voxel = false;
  std::uint32_t min_hits = 2;  ///< points with fewer readings are omitted
  /// Omits pooled points with less than this share of the upper quartile of the evidence of points
  /// within 4 lengths and normals within 60°: the halo at silhouettes. 0 keeps all. Evidence is the
  /// number of readings relative to one frontal view at the same range, so that surface seen from
  /// afar and the less seen side of a thin wall are kept.
  double min_relative_evidence = 0.25;
  double normal_radius = 5.0;  ///< radius of the ball whose beliefs give the surface normal, at
                               ///< most 8 [pooling lengths]
  double column_radius = 1.0;  ///< radius of the pooled column [pooling lengths]
  /// Half height of the column, in sigmas of one reading across the surface.
  double column_sigmas = 1.75;
  /// Minimum distance between pooled points whose normals are within 90° [pooling lengths]; 0 keeps
  /// all. A nearer point, down to 0.4 lengths, is kept if its removal would leave a hole, judged by
  /// discs of one length or min_distance. Rare small gaps remain.
  double min_distance = 0.75;
  /// Square root of F [m], the variance added in all directions for errors common to a point's
  /// readings and for blur from pooling. Default F: edge² / 12 with per_voxel; otherwise min(1, 0.2
  /// + 2 / e) · ((0.19 σ)² + (0.43 s)² + (0.02 edge)²) with the evidence e in frontal views, the σ
  /// of one reading along the normal, the scatter s of the voxel means in the column, and the edge
  /// of the pooled voxels or cubes.
  std::optional<double> floor_sigma{};
  /// Sensor::scale_sigma of the camera. Adds the effect of such a scale error, common to all
  /// readings of a point, to its covariance: scale_sigma² w wᵀ. w [m] is the mean vector from the
  /// views on the point's free side, weighted by their number of readings, ignoring occlusion. Maps
  /// without views have no such term.
  double scale_sigma = 0;
  /// Starts points only at voxels, or cubes, whose centre [m, world frame] satisfies this; empty:
  /// at all. Points within a few lengths of the border can differ from those of the whole map.
  std::function<bool(const Eigen::Vector3d&)> where{};
};

/// Surface points of a map, with covariances. A pooled point starts at an occupied voxel, or a cube
/// of voxels (pooling_of), and moves along the local normal to the mean of the readings in its
/// column, including those of voxels that became free. Its covariance is that of the mean, plus F
/// and the term of scale_sigma. Thin walls keep both sides; redundant points are thinned out
/// (min_distance). grid/README.md ("Surface points") has the details.
///
/// Points are ordered by scale, finest first, then by the starting voxel or cube; each scale is
/// pooled separately. Deterministic for any number of threads. Cost: about 1 µs per voxel that was
/// ever hit where config.where is true, 0.3 µs elsewhere. Throws Error(invalid_argument) naming a
/// setting that is negative, not finite or too large.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<FusedPoint> fused_points(
    const BeliefGrid& grid, const FusedPointsConfig& config = {}, const ExecConfig& exec = {});

/// The length over which readings of one place are combined. Voxels finer than the sensor's
/// footprint hold too few readings each, however often a place was seen.
struct VIEWGAIN_EXPORT Pooling {
  int shift = 0;      ///< beliefs are summed in cubes of 2^shift voxels per edge, at most 3
  double length = 0;  ///< edge of the cubes or the footprint, whichever is longer [m]
};

/// Pooling of a map. The footprint is the median over the occupied voxels of a reading's sigma
/// across its ray, estimated from Λ_v / hits. Cubes are as large as possible below 1.42 footprints;
/// a map with voxels of at least that size has shift 0. With a scale, 0 to 3: the pooling of its
/// leaves, with cubes of at least their cell size. Never throws. Thread safe. Cost: about 20 ns per
/// occupied voxel.
[[nodiscard]] VIEWGAIN_EXPORT Pooling pooling_of(const GridSnapshot& snapshot,
                                                 std::optional<int> scale = {});

}  // namespace viewgain
