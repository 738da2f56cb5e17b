// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/mesh/patch.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"

namespace viewgain::detail {

/// What the next view of a patch shall look at.
struct ViewTarget {
  Eigen::Vector3d point;   ///< world [m]
  Eigen::Vector3d normal;  ///< outward
  Eigen::Vector3d across;  ///< tangent, away from the boundary
};

/// Slides along u, from the boundary on, until a camera that looks straight at the patch from
/// `distance` [m] sees the boundary where it leaves `overlap` of the image on its known side; ends
/// before that at the depth of the patch or a turn of max_turn [rad].
[[nodiscard]] ViewTarget next_view_target(const QuadraticPatch& patch, const PinholeCamera& camera,
                                          double distance, double overlap, double max_turn,
                                          const Eigen::Vector3d& up);

/// Where, along `direction` of the image (unit), a straight line across it lies that has `share`
/// of the image behind it: in units of the focal length, from the optical axis, without
/// distortion.
[[nodiscard]] double line_for_share(const PinholeCamera& camera, const Eigen::Vector2d& direction,
                                    double share);

/// All variants of a view of this target, in the order of EstimatorConfig.
void append_variants(const ViewTarget& target, double working_distance,
                     const EstimatorConfig& config, const BoundaryCandidate& prototype,
                     std::vector<BoundaryCandidate>& candidates);

}  // namespace viewgain::detail
