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

/// A named set of fixed poses: sphere, dome, rings, sequence, file.
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
  std::optional<Pose> start{};  ///< T_world_camera of the previous view (sequence, spread_out)
  /// Orders the poses so that the first ones are spread evenly, whatever their number: each is as
  /// far as possible from the start and from all earlier poses, by direction. Ties go to the lower
  /// index.
  bool spread_out = false;
  ReachRegion reach{};  ///< reach of the robot (shell); lists of poses in it have no effect here
};

/// Centre of the workspace, and the distance from which an object as large as the workspace fills
/// the image. Constant time.
[[nodiscard]] VIEWGAIN_EXPORT PoseSetRequest around_workspace(const BeliefGrid& grid,
                                                              const Sensor& sensor);

/// The set of a generator other than boundary. Shell: random poses that look at the centre, between
/// 0.8 and 1.25 times the distance, or within the reach's shells or boxes if it has any. It has
/// fewer poses than requested if few random poses are within reach. Sequence: eight views on the
/// start's circle of latitude in steps of 45°, then one from above. Throws Error(invalid_argument)
/// for an unknown name, an unsupported count, and more than 20,000 poses to spread out.
[[nodiscard]] VIEWGAIN_EXPORT PoseSet make_pose_set(std::string_view generator,
                                                    const PoseSetRequest& request);

/// Distance from which a sphere of this radius [m] fills the smaller side of the image; at least
/// the sensor's working distance [m]. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT double filling_distance(const Sensor& sensor, double radius);

}  // namespace viewgain
