// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Contents of a point cloud file.
struct VIEWGAIN_EXPORT PointCloud {
  /// Points in file order, in the file's frame and unit. In an organised cloud, pixels without a
  /// measured depth are NaN.
  std::vector<std::array<double, 3>> points;
  /// A PCD's VIEWPOINT: the sensor's pose in the points' frame, without rotation if its quaternion
  /// is 0.
  std::optional<Pose> viewpoint;
};

/// Reads a .pcd (ascii, binary) or .ply (ascii, binary of either byte order), chosen by the file
/// name's ending; the points of a PLY are the element "vertex". Ignores fields other than x, y, z.
/// Points need not be finite. Throws Error(io) if the file cannot be opened, and Error(capacity)
/// above 16 GiB. Throws Error(format), with the file and (in text files) the line, for another
/// ending, a missing field, an invalid number, a count that contradicts the file's length, or a
/// viewpoint whose quaternion has a norm that differs from 1 by more than 1e-2. Cost: O(points).
[[nodiscard]] VIEWGAIN_EXPORT PointCloud load_cloud(const std::filesystem::path& path);

}  // namespace viewgain
