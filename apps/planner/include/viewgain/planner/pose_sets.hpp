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

/// A fixed set of poses with a name: sphere, dome, rings, sequence, file.
struct VIEWGAIN_EXPORT PoseSet {
  std::string generator;    ///< its name
  std::vector<Pose> poses;  ///< T_world_camera, in the generator's order
};

/// The generators of candidates by name, in this order: boundary, sphere, dome, rings, shell,
/// sequence.
[[nodiscard]] VIEWGAIN_EXPORT const std::vector<std::string>& generator_names();

/// What the pose sets are made for.
struct VIEWGAIN_EXPORT PoseSetRequest {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< what they look at, world [m]
  double distance = 0;                               ///< from it [m]
  /// 500 unless given; rings: 48, 80, 288 or 864, 48.
  std::optional<std::size_t> count{};
  std::uint64_t seed = 1;       ///< shell
  std::optional<Pose> start{};  ///< T_world_camera of the view before (sequence, spread_out)
  /// Puts the set's poses into an order in which any number of the first ones are spread evenly:
  /// each as far as can be from the start's direction and those before it, ties to the lower index.
  bool spread_out = false;
  ReachRegion reach{};  ///< of the robot (shell); a list of poses says nothing here
};

/// The workspace's centre, and the distance from which an object that the workspace has room for
/// fills the image. Costs constant time.
[[nodiscard]] VIEWGAIN_EXPORT PoseSetRequest around_workspace(const BeliefGrid& grid,
                                                              const Sensor& sensor);

/// The set of a generator other than boundary. Shell: where the reach has shells
/// or boxes at random in these, looking at the centre, fewer than asked for where few of a million
/// lie in all that limits the reach; else between 0.8 and 1.25 times the distance.
/// Sequence: eight views on the start's circle of latitude, in steps of 45°, then one from above.
/// Throws Error(invalid_argument) for an unknown name, a count that the generator has not, and more
/// than 20,000 poses to spread out.
[[nodiscard]] VIEWGAIN_EXPORT PoseSet make_pose_set(std::string_view generator,
                                                    const PoseSetRequest& request);

/// Distance from which a sphere of this radius [m] fills the smaller side of the image; at least
/// the sensor's working distance [m]. Checks nothing.
[[nodiscard]] VIEWGAIN_EXPORT double filling_distance(const Sensor& sensor, double radius);

}  // namespace viewgain
