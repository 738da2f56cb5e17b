// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace viewgain::bench {

/// An object and its candidate views, as published by NBV-Simulation.
struct PublishedObject {
  std::vector<Eigen::Vector3d> points;               ///< on its surface, world frame [m]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< target of the views [m]
  double size = 0;                    ///< half the side of the mapped cube around the centre [m]
  std::vector<Eigen::Vector3d> eyes;  ///< candidate positions [m]; the first is the start
};

/// Reads FOLDER/3d_models/Armadillo.pcd (points) and Armadillo.txt (number of views, centre, size,
/// positions). By the rules of that project, points are in mm if a coordinate is 10 or more. An
/// object is scaled to a size of 0.1 if its size, for 92 % of its points, is larger. Throws
/// Error(io) and Error(format) that name the file and, for text, the line.
[[nodiscard]] PublishedObject read_published_object(const std::filesystem::path& folder);

/// Reads positions in the format of MA-SCVP's view_space.txt: their number, then x y z [m] per
/// line. Throws like above.
[[nodiscard]] std::vector<Eigen::Vector3d> read_view_space(const std::filesystem::path& path);

/// Their `predicted_size` [m]: 1.2 times half the side of a cube around the centre. The side is
/// halved until the share of the points inside, with the target `aim`, changes by less than 0.001.
[[nodiscard]] double predicted_size(const std::vector<Eigen::Vector3d>& points,
                                    const Eigen::Vector3d& center, double aim);

}  // namespace viewgain::bench
