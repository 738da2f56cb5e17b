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

/// Settings of the viewpoint estimator. A boundary run is a stretch of boundary of one class
/// (BoundaryRun).
struct VIEWGAIN_EXPORT EstimatorConfig {
  BoundaryConfig boundary{};  ///< how boundaries are cut
  /// Boundary runs that are longer than this are cut into parts of about this length [m].
  double patch_length = 0.06;
  /// Inward extent of the surface region to which a patch is fitted [m].
  double region_depth = 0.05;
  double overlap = 0.5;  ///< fraction of a view that known surface should fill, in (0, 1)
  /// The extrapolation stops where the patch's normal has rotated by this angle [rad].
  double max_turn = 60.0 * std::numbers::pi / 180;
  /// Candidates are made for all combinations of distances, tilts and rolls, with rolls varying
  /// fastest. Distances are multiples of the working distance. Tilts are in (-pi/2, pi/2). A tilt
  /// other than 0 gives two candidates: tilted about the boundary's direction v (positive: the
  /// camera moves outward), and about the direction u across the boundary.
  std::vector<double> distances{1.0};
  std::vector<double> tilts{0.0};  ///< [rad]
  std::vector<double> rolls{0.0};  ///< about the optical axis [rad]
  /// Unit vector, world frame, that points up in the image at roll 0, as nearly as the viewing
  /// direction allows.
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// A candidate, and the boundary that it comes from.
struct VIEWGAIN_EXPORT BoundaryCandidate {
  Pose T_world_camera;                                 ///< camera pose
  BoundaryClass boundary_class = BoundaryClass::left;  ///< class of its boundary run
  std::uint32_t run = 0;                               ///< index into EstimatedViews::runs
  std::uint32_t patch = 0;                             ///< index into patches and regions
  Eigen::Vector3d target = Eigen::Vector3d::Zero();    ///< point it looks at, world [m]
  double distance = 0;                                 ///< distance from the target [m]
  double tilt = 0, roll = 0;                           ///< tilt and roll of the variant [rad]
  bool nominal = false;  ///< whether tilt and roll are 0 and the distance is the first
};

/// Candidates, and the boundary runs and patches that they come from.
struct VIEWGAIN_EXPORT EstimatedViews {
  /// The boundary loops, split where the class changes. The order is that of boundary_runs().
  std::vector<BoundaryRun> runs;
  std::vector<QuadraticPatch> patches;              ///< one per part of a boundary run
  std::vector<std::vector<std::uint32_t>> regions;  ///< vertices of each patch's fit
  std::vector<std::uint32_t> run_of_patch;          ///< index of each patch's boundary run
  std::vector<BoundaryCandidate> candidates;        ///< ordered by boundary run, patch and variant
};

/// Proposes views past the boundaries of a surface, after Kriegel et al., ICRA 2011. The paper
/// does not state all sizes and thresholds; those here are our own. The estimator fits a patch to
/// a surface region at each boundary run, extrapolates the patch, and places views in front of it.
///
/// Boundary runs longer than patch_length are cut into equal parts, closed ones into three or more.
/// For each part, a patch is fitted to the vertices of grow_region() whose normals differ by less
/// than 45° from the mean. Its origin is the mean of the part's edges. The target of a view lies on
/// the extrapolated patch, where known surface fills the fraction `overlap` of the nominal view.
/// The extrapolation ends at the depth of the region or at max_turn. The camera looks at the target
/// from distance · working_distance away, along the patch's normal.
///
/// `views` are the poses T_world_camera, in the order in which they were taken.
/// `working_distance` is in metres.
/// `sees` has the same meaning as in boundary_runs().
///
/// Throws Error(invalid_argument) for an overlap outside (0, 1), an empty list of variants, lengths
/// that are not positive, or no views. Also throws whatever boundary_loops() and boundary_runs()
/// throw. An empty or closed surface gives no candidates. Deterministic. Cost: 30 ms for 17,000
/// vertices and 108 patches on one core.
[[nodiscard]] VIEWGAIN_EXPORT EstimatedViews estimate_views(
    const SurfaceMesh& surface, std::span<const Pose> views, const Sensor& sensor,
    double working_distance, const EstimatorConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
