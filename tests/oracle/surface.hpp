// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/rays.hpp"
#include "viewgain/grid/hazard.hpp"

namespace viewgain::oracle {

/// What a ray could bring that is there or not.
struct SurfaceValue {
  double area = 0;                  ///< [m²]
  double refinement_saturated = 0;  ///< [nat]
  double gain = 0;                  ///< of the configured model
  /// The most that one pixel adds, and besides all that hangs on comparisons that rounding decides.
  double pixel_area = 0;        ///< [m²]
  double pixel_refinement = 0;  ///< [nat]
};

/// What is known of the surface at a voxel.
struct Pool {
  /// Of the readings of the occupied ones among the 27 voxels centred on it [m⁻²]. Where it is of a
  /// larger scale, of the 27 cells, as far as each is a piece of surface of 4^scale voxels.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  int voxels = 0;  ///< how many of these have readings; 0 if the voxel itself has none
};
[[nodiscard]] Pool pool_of(const BeliefGrid& grid, const DenseMap& map, Index3 voxel);

/// ½ Σ_k ln ([prior_sigma⁻² I + Λ]⁻¹ + floor I)_kk [nat]; `floor` [m²].
[[nodiscard]] double pooled_entropy(const Pool& pool, double prior_sigma, double floor);

/// The surface and the combined gain of raycast/README.md for one pose outside occupied voxels,
/// without a support plane. Hazards come from `hazard`, which has tests of its own.
[[nodiscard]] SurfaceValue surface_value(const BeliefGrid& grid, const DenseMap& map,
                                         const HazardField& hazard, const Sensor& sensor,
                                         const GainConfig& config, const Pose& T_world_camera,
                                         const Obstacles& obstacles = {});

/// The distance between the centres of the cells (2^shift voxels an edge) of a voxel and of the
/// nearest occupied voxel [m] in a cube of 2^pooling voxels whose occupied voxels have three hits
/// between them; infinity if there is none.
[[nodiscard]] double distance_to_evidence(const BeliefGrid& grid, int shift, Index3 voxel,
                                          int pooling = 0);

}  // namespace viewgain::oracle
