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

/// How boundaries become candidate views.
struct VIEWGAIN_EXPORT EstimatorConfig {
  BoundaryConfig boundary{};   ///< how boundaries are cut
  double patch_length = 0.06;  ///< longer runs are cut into pieces of about this length [m]
  double region_depth = 0.05;  ///< how far the region grows inward [m]
  double overlap = 0.5;        ///< share of the next view that shows known surface, in (0, 1)
  double max_turn = 60.0 * std::numbers::pi / 180;  ///< bound of the extrapolation [rad]
  /// Variants, all combinations, in the order distances outermost and rolls innermost: distances as
  /// multiples of the working distance, tilts in (-pi/2, pi/2) [rad], rolls about the optical axis
  /// [rad]. A tilt of 0 is one variant, another is two: first about the boundary's direction v
  /// (positive: the camera moves outward), then about the direction u across it.
  std::vector<double> distances{1.0};
  std::vector<double> tilts{0.0};                 ///< in their order [rad]
  std::vector<double> rolls{0.0};                 ///< in their order, about the optical axis [rad]
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< roll 0: image up is as near to this direction
                                                  ///< [1], in the world, as can be
};

/// A candidate and why it exists.
struct VIEWGAIN_EXPORT BoundaryCandidate {
  Pose T_world_camera;                                 ///< where the camera would be
  BoundaryClass boundary_class = BoundaryClass::left;  ///< of its run
  std::uint32_t run = 0;                               ///< index into EstimatedViews::runs
  std::uint32_t patch = 0;                             ///< index into patches and regions
  Eigen::Vector3d target = Eigen::Vector3d::Zero();    ///< the point it looks at, world [m]
  double distance = 0;                                 ///< from the target [m]
  double tilt = 0, roll = 0;                           ///< of the variant [rad]
  bool nominal = false;  ///< the untilted, unrolled variant at the first distance
};

/// Candidates, and the runs and patches that they come from.
struct VIEWGAIN_EXPORT EstimatedViews {
  std::vector<BoundaryRun> runs;        ///< loops cut by class, in the order of boundary_runs()
  std::vector<QuadraticPatch> patches;  ///< one a piece of a run
  std::vector<std::vector<std::uint32_t>> regions;  ///< of each patch: vertices it is fitted to
  std::vector<std::uint32_t> run_of_patch;          ///< of each patch: index into runs
  std::vector<BoundaryCandidate> candidates;        ///< in the order runs, patches, variants
};

/// The paper's viewpoint estimator (after Kriegel et al., ICRA 2011; published details of the
/// original are not available, so this definition is ours): boundary runs -> regions -> patches ->
/// views.
///
/// A run longer than patch_length is cut into equal pieces, a closed one into three at least; a
/// piece's patch has its origin at the mean of the edges, u from the mean conormal and w from the
/// mean normal, and is fitted to the vertices that grow_region finds at a turn of under 45°. A
/// patch is extrapolated past the boundary along u by as much as the wanted overlap asks of the
/// sensor's footprint at the working distance: in the nominal view the boundary, a straight line
/// across u, has that share of the image behind it (½ - overlap of the footprint for a plane, if u
/// runs along a side of the image; inward if the overlap is over ½), at most by the depth of its
/// region and until it has turned by max_turn. The candidate stands at distance · working_distance
/// from that point along its outward normal and looks back along it.
///
/// `views` are T_world_camera in the order in which they were taken, working_distance [m]. `sees`
/// is asked as in boundary_runs. Throws Error(invalid_argument) for an overlap outside (0, 1), an
/// empty list of variants, lengths that are not positive, no views, and what boundary_loops and
/// boundary_runs refuse. An empty or closed surface gives no candidates; pieces without a direction
/// (no area, or conormals that cancel) have no patch. Deterministic. Cost: 30 ms for 17,000
/// vertices with 77 runs and 108 patches, on one core (mesh/README.md).
[[nodiscard]] VIEWGAIN_EXPORT EstimatedViews estimate_views(
    const SurfaceMesh& surface, std::span<const Pose> views, const Sensor& sensor,
    double working_distance, const EstimatorConfig& config = {},
    const std::function<bool(std::size_t view, const Eigen::Vector3d& point)>& sees = {});

}  // namespace viewgain
