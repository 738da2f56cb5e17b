// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/mesh/boundary.hpp"
#include "viewgain/mesh/patch.hpp"

namespace viewgain {

/// Settings of the viewpoint estimator.
struct VIEWGAIN_EXPORT EstimatorConfig {
  BoundaryConfig boundary{};   ///< how boundaries are cut
  double patch_length = 0.06;  ///< longer runs are cut into parts of about this length [m]
  /// Inward extent of the surface region to which a patch is fitted [m].
  double region_depth = 0.05;
  double overlap = 0.5;  ///< fraction of a view that known surface should fill, in (0, 1)
  double max_turn = 60.0 * std::numbers::pi / 180;  ///< largest turn of the extrapolation [rad]
  /// Candidates are made for all combinations of distances, tilts and rolls, with rolls varying
  /// fastest. Distances are multiples of the working distance. Tilts are in (-pi/2, pi/2). A tilt
  /// other than 0 gives two candidates: tilted about the boundary's direction v (positive: the
  /// camera moves outward), and about the direction u across the boundary.
  std::vector<double> distances{1.0};
  std::vector<double> tilts{0.0};                 ///< [rad]
  std::vector<double> rolls{0.0};                 ///< about the optical axis [rad]
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< direction [1] of image up at roll 0, world
                                                  ///< frame; approximated as well as possible
};

/// A candidate, and the boundary that it comes from.
struct VIEWGAIN_EXPORT BoundaryCandidate {
  Pose T_world_camera;                                 ///< camera pose
  BoundaryClass boundary_class = BoundaryClass::left;  ///< class of its run
  std::uint32_t run = 0;                               ///< index into EstimatedViews::runs
  std::uint32_t patch = 0;                             ///< index into patches and regions
  Eigen::Vector3d target = Eigen::Vector3d::Zero();    ///< point it looks at, world [m]
  double distance = 0;                                 ///< distance from the target [m]
  double tilt = 0, roll = 0;                           ///< tilt and roll of the variant [rad]
  bool nominal = false;  ///< whether tilt and roll are 0 and the distance is the first
};

/// Candidates, and the runs and patches that they come from.
struct VIEWGAIN_EXPORT EstimatedViews {
  std::vector<BoundaryRun> runs;        ///< loops cut by class, in the order of boundary_runs()
  std::vector<QuadraticPatch> patches;  ///< one per part of a run
  std::vector<std::vector<std::uint32_t>> regions;  ///< vertices of each patch's fit
  std::vector<std::uint32_t> run_of_patch;          ///< index of each patch's run
  std::vector<BoundaryCandidate> candidates;        ///< ordered by run, patch and variant
};

/// Proposes views past the boundaries of a surface, after Kriegel et al., ICRA 2011. The paper
/// does not state all sizes and thresholds; those here are our own. The estimator fits a patch to
/// a surface region at each boundary run, extrapolates the patch, and places views in front of it.
///
/// Runs longer than patch_length are cut into equal parts, closed runs into three or more. For
/// each part, a patch is fitted to the vertices of grow_region() within a turn of 45°. Its origin
/// is the mean of the part's edges. The target of a view lies on the extrapolated patch, where
/// known surface fills the fraction `overlap` of the nominal view. The extrapolation ends at the
/// depth of the region or at a turn of max_turn. The camera stands at distance · working_distance
/// from the target, along the patch's normal there, and looks at the target.
///
/// `views` are T_world_camera in the order taken, working_distance [m]; `sees` as in boundary_runs.
/// Throws Error(invalid_argument) for an overlap outside (0, 1), an empty list of variants, lengths
/// that are not positive, no views, and like boundary_loops() and boundary_runs(). An empty or
/// closed surface gives no candidates. Deterministic. Cost: 30 ms for 17,000 vertices and 108
/// patches on one core.
[[nodiscard]] VIEWGAIN_EXPORT EstimatedViews estimate_views(
    const SurfaceMesh& surface, std::span<const Pose> views, const Sensor& sensor,
    double working_distance, const EstimatorConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
