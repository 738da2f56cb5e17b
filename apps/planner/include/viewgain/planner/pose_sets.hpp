// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"

namespace viewgain {

/// A named set of fixed poses, from make_pose_set() or from a file.
struct VIEWGAIN_EXPORT PoseSet {
  std::string generator;    ///< name of the generator
  std::vector<Pose> poses;  ///< T_world_camera, in the generator's order
};

/// Names of the generators, in this order: boundary, sphere, dome, rings, shell, sequence.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& generator_names();

/// Parameters of the pose sets.
struct VIEWGAIN_EXPORT PoseSetRequest {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< point that the poses look at, world [m]
  double distance = 0;                               ///< distance of the poses from the centre [m]
  /// Number of poses: 500 by default; rings: 48 (default), 80, 288 or 864.
  std::optional<std::size_t> count{};
  std::uint64_t seed = 1;       ///< seed of the shell
  std::optional<Pose> start{};  ///< T_world_camera of the previous view; used by the generator
                                ///< sequence and by spread_out
  /// Orders the poses so that the first n are spread evenly, for every n. The next pose is always
  /// the one whose direction from the centre differs most from the directions of the start and of
  /// all earlier poses. Ties go to the lower index.
  bool spread_out = false;
  /// Reach of the robot. Only the generator shell uses it, unless the reach has a list of
  /// poses.
  ReachRegion reach{};
};

/// Centre of the workspace, and the distance from which an object as large as the workspace fills
/// the image. Constant time.
[[nodiscard]] VIEWGAIN_EXPORT PoseSetRequest around_workspace(const BeliefGrid& grid,
                                                              const Sensor& sensor);

/// The set of a generator other than boundary. The sets sphere, dome and rings are those of
/// viewgain/core/generators.hpp. The other sets are:
/// - shell: random poses that look at the centre. If `reach` has shells or boxes, the poses lie
///   within reach; otherwise they are at 0.8 to 1.25 times `distance` from the centre. The set is
///   smaller than requested if few random poses are within reach.
/// - sequence: eight views in steps of 45°, on a horizontal circle through the start, then one from
///   above.
///
/// Throws Error(invalid_argument) for an unknown name, an unsupported count, and more than 20,000
/// poses to spread out.
[[nodiscard]] VIEWGAIN_EXPORT PoseSet make_pose_set(std::string_view generator,
                                                    const PoseSetRequest& request);

/// Distance from which a sphere of this radius [m] fills the smaller side of the image; at least
/// the sensor's working distance [m]. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT double filling_distance(const Sensor& sensor, double radius);

}  // namespace viewgain
