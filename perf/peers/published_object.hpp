// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace viewgain::bench {

/// An object and its candidate views as NBV-Simulation publishes them.
struct PublishedObject {
  std::vector<Eigen::Vector3d> points;               ///< of its surface, world [m]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< what the views look at [m]
  double size = 0;                    ///< half the side of the mapped cube round the centre [m]
  std::vector<Eigen::Vector3d> eyes;  ///< candidate positions [m]; the first is the start
};

/// Reads FOLDER/3d_models/Armadillo.pcd (points) and Armadillo.txt (number of views, centre, size,
/// positions). By that project's rules points are in mm where a coordinate is 10 or more, and an
/// object whose size, for 92 % of its points, is over 0.1 is scaled to that. Throws Error(io) and
/// Error(format), naming the file, and for text the line.
[[nodiscard]] PublishedObject read_published_object(const std::filesystem::path& folder);

/// The positions of a list as MA-SCVP's view_space.txt is: their number, then x y z a line [m].
/// Throws as above.
[[nodiscard]] std::vector<Eigen::Vector3d> read_view_space(const std::filesystem::path& path);

/// 1.2 times half the side of the cube round the centre that is found by halving until the share of
/// the points inside, aimed at `aim`, moves by less than 0.001: their `predicted_size` [m].
[[nodiscard]] double predicted_size(const std::vector<Eigen::Vector3d>& points,
                                    const Eigen::Vector3d& center, double aim);

}  // namespace viewgain::bench
