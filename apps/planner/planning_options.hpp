// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "candidate_generation.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::app {

/// The names that --generator takes: boundary, sphere, dome, rings, shell, sequence.
[[nodiscard]] const std::vector<std::string>& generator_names();

/// What the pose sets are made for.
struct PoseSetRequest {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< what they look at [m]
  double distance = 0;                               ///< from it [m]
  std::optional<std::size_t> count{};  ///< 500 unless given; rings: 48, 80, 288 or 864, 48
  std::uint64_t seed = 1;              ///< shell
  std::optional<Pose> start{};         ///< sequence: first view of the turntable
};

/// The set of a generator other than boundary. Shell: between 0.8 and 1.25 times the distance.
/// Sequence: eight views on the start's circle of latitude, in steps of 45°, then one from above.
/// Throws Error(invalid_argument) for an unknown name or a count that the generator has not.
[[nodiscard]] PoseSet make_pose_set(std::string_view generator, const PoseSetRequest& request);

/// Distance from which a sphere of this radius [m] fills the smaller side of the image; at least
/// the sensor's working distance.
[[nodiscard]] double filling_distance(const Sensor& sensor, double radius);

/// A number of variants that makes a large batch: two distances, tilts of 15° to four sides, two
/// rolls; two fifths of a view overlap with what is known.
[[nodiscard]] EstimatorConfig default_estimator(double voxel_size);

/// tx,ty,tz,qx,qy,qz,qw. Throws Error(invalid_argument) naming the flag.
[[nodiscard]] Pose parse_pose(std::string_view flag, std::string_view text);

/// A list of names separated by commas. Throws Error(invalid_argument) naming the flag for an empty
/// or unknown one.
[[nodiscard]] std::vector<std::string> parse_names(std::string_view flag, std::string_view text,
                                                   const std::vector<std::string>& valid);

}  // namespace viewgain::app
