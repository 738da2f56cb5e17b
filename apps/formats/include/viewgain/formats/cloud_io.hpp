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

/// The points of a file.
struct VIEWGAIN_EXPORT PointCloud {
  /// In file order, as they stand there, in the file's frame and in whatever unit it has; an
  /// organised cloud's pixels without a reading are NaN.
  std::vector<std::array<double, 3>> points;
  /// A PCD's VIEWPOINT: the sensor's pose in the points' frame, not turned if its quaternion is 0.
  std::optional<Pose> viewpoint;
};

/// Reads a .pcd (ascii, binary) or .ply (ascii, binary of either byte order),
/// chosen by the name's ending; PLY's points are the element "vertex". Fields other than x, y, z
/// are left out. Throws Error(io) if the file cannot be opened and Error(format), naming the file
/// and, in text, the line, if a field is missing, a count contradicts the file's length, a word is
/// no number, the viewpoint's quaternion is off by more than 1e-2, or the name ends otherwise.
/// Points need not be finite. Throws Error(capacity) for a file over 16 GiB. Cost: O(points); the
/// file is read once.
[[nodiscard]] VIEWGAIN_EXPORT PointCloud load_cloud(const std::filesystem::path& path);

}  // namespace viewgain
