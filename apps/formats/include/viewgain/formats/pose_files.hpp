// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose_io.hpp"

/// @file
/// Files of poses, T_world_camera, whose ending says the format: .npy for numpy, else TUM text.
/// Cost: a file is read or written once, O(poses) in time and memory.

namespace viewgain {

/// Reads TUM text (read_tum()), or for a name that ends in .npy an array that numpy wrote: rows
/// with the columns tx, ty, tz, qx, qy, qz, qw and perhaps timestamp, or matrices (n, 4, 4), of
/// float64 or float32, in C's or Fortran's order. Timestamps are 0, 1, 2, ... if there are none.
/// Throws what read_tum() throws; of a .npy an error names the row.
[[nodiscard]] VIEWGAIN_EXPORT PoseList load_poses(const std::filesystem::path& path);

/// Writes what load_poses() reads: TUM text for .txt and .tum, for .npy rows with timestamp, tx,
/// ty, tz, qx, qy, qz, qw. Throws what write_tum() throws, and Error(invalid_argument), naming the
/// endings, for other names (not for pipes and devices).
VIEWGAIN_EXPORT void save_poses(const std::filesystem::path& path, std::span<const Pose> poses);
/// The same with timestamps [s], one per pose.
VIEWGAIN_EXPORT void save_poses(const std::filesystem::path& path, std::span<const Pose> poses,
                                std::span<const double> timestamps);

/// What is wrong with the ending of a file that save_poses() is to write; empty: nothing. Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string fault_of_poses_name(const std::filesystem::path& path);

}  // namespace viewgain
