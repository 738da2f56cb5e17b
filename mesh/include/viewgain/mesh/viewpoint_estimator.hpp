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

/// Settings of estimate_views(). A boundary run is a part of the surface's boundary with one class
/// (BoundaryRun). A patch is a quadric fitted to the surface at a boundary run (QuadraticPatch); u
/// is its direction across the boundary and v that along the boundary.
struct VIEWGAIN_EXPORT EstimatorConfig {
  BoundaryConfig boundary{};  ///< how boundaries are cut into boundary runs
  /// Boundary runs longer than this are cut into parts of about this length [m]. Each part gets a
  /// patch.
  double patch_length = 0.06;
  /// A patch is fitted to surface up to this distance from the boundary [m].
  double region_depth = 0.05;
  double overlap = 0.5;  ///< fraction of the image that known surface should fill, in (0, 1)
  /// The extrapolation of a patch stops where its normal has rotated by this angle [rad].
  double max_turn = 60.0 * std::numbers::pi / 180;
  /// For each patch, there is a candidate for each combination of distance, tilt and roll; rolls
  /// vary fastest. Distances are in working distances. Tilts are in (-pi/2, pi/2). A tilt other
  /// than 0 gives two candidates: one is tilted about v, where positive tilts move the camera
  /// outward, and one about u.
  std::vector<double> distances{1.0};
  std::vector<double> tilts{0.0};  ///< [rad]
  std::vector<double> rolls{0.0};  ///< rotation about the optical axis [rad]
  /// Direction in the world frame that points up in the image at roll 0, as closely as the viewing
  /// direction allows. Unit length.
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// A candidate, and the part of the boundary that it looks at.
struct VIEWGAIN_EXPORT BoundaryCandidate {
  Pose T_world_camera;                                 ///< camera pose
  BoundaryClass boundary_class = BoundaryClass::left;  ///< class of its boundary run
  std::uint32_t run = 0;                               ///< index into EstimatedViews::runs
  std::uint32_t patch = 0;  ///< index into EstimatedViews::patches and regions
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< point it looks at, world [m]
  double distance = 0;                               ///< distance of the camera from the target [m]
  double tilt = 0, roll = 0;                         ///< tilt and roll [rad]
  bool nominal = false;  ///< tilt and roll are 0, and the distance is distances[0]
};

/// Candidates, with the boundary runs and patches from which they were made.
struct VIEWGAIN_EXPORT EstimatedViews {
  /// All boundary runs, in the order of boundary_runs().
  std::vector<BoundaryRun> runs;
  std::vector<QuadraticPatch> patches;              ///< one per part of a boundary run
  std::vector<std::vector<std::uint32_t>> regions;  ///< vertices to which each patch was fitted
  std::vector<std::uint32_t> run_of_patch;          ///< index of each patch's boundary run
  std::vector<BoundaryCandidate> candidates;        ///< ordered by boundary run, then patch
};

/// Proposes views of the unknown space beyond the boundaries of a surface, after Kriegel et al.,
/// ICRA 2011. Their paper does not state all sizes and thresholds; the missing ones are our own.
///
/// Boundary runs longer than patch_length are cut into equal parts; closed ones are cut into three
/// or more. For each part, a patch is fitted to a region from grow_region(), with a max_turn of
/// 45°. The origin of the patch is the mean position of the part's edges. The target of a view is a
/// point of the patch, usually beyond the boundary. It is chosen so that known surface fills the
/// fraction `overlap` of the image. It is at most the region's depth away from the boundary, and
/// the normal there has rotated by at most EstimatorConfig::max_turn. At tilt 0, the camera looks
/// at the target against the normal of the patch.
///
/// `views` are T_world_camera, in the order in which they were taken. `working_distance` is in
/// metres. `sees` is as in boundary_runs().
///
/// An empty or closed surface gives no candidates. Throws Error(invalid_argument) if overlap is
/// outside (0, 1), distances, tilts or rolls is empty, a length is not positive, or there are no
/// views. Also throws whatever boundary_loops() and boundary_runs() throw. Deterministic. Cost: 30
/// ms for 17,000 vertices and 108 patches on one core.
[[nodiscard]] VIEWGAIN_EXPORT EstimatedViews estimate_views(
    const SurfaceMesh& surface, std::span<const Pose> views, const Sensor& sensor,
    double working_distance, const EstimatorConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
