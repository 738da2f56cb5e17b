// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

/// @file
/// Reads and writes poses (T_world_camera) in text files. Each call reads or writes the file once.
/// Cost: O(poses) in time and memory.

namespace viewgain {

class LineReader;

/// Poses from a file, and how many of them were repaired.
struct VIEWGAIN_EXPORT PoseList {
  std::vector<Pose> poses;         ///< T_world_camera, in file order
  std::vector<double> timestamps;  ///< [s], one per pose
  /// Number of poses that were repaired because the norm of the quaternion differed from 1 by more
  /// than 1e-5.
  std::size_t orthonormalized = 0;
};

/// Reads the TUM format: one pose per line, "timestamp tx ty tz qx qy qz qw", with the timestamp in
/// [s], the translation in [m] and a quaternion. Skips a byte order mark, empty lines and lines
/// that begin with #. Normalises quaternions whose norm is within 1e-2 of 1. Throws Error(io) if
/// the file cannot be read and Error(capacity) above 1 GiB. Throws Error(format) with file and line
/// for other faults, and if there are no poses.
[[nodiscard]] VIEWGAIN_EXPORT PoseList read_tum(const std::filesystem::path& path);

/// The pose in the current line of the reader, in the TUM format. For files that are still being
/// written. Sets *orthonormalized to true if the norm of the quaternion differed from 1 by more
/// than 1e-5. Throws Error(format) for the same faults as read_tum().
[[nodiscard]] VIEWGAIN_EXPORT Pose tum_line_pose(const LineReader& line,
                                                 bool* orthonormalized = nullptr);

/// Writes the TUM format with 17 significant digits and the timestamps 0, 1, 2, ... When read back,
/// translations are exact and rotations agree to 2e-15. Atomic: renames a temporary file. Throws
/// Error(io) if the file cannot be written. Throws Error(invalid_argument) if the name of a regular
/// file does not end in .txt or .tum, or a pose is not rigid within 1e-2.
VIEWGAIN_EXPORT void write_tum(const std::filesystem::path& path, std::span<const Pose> poses);
/// As above, with one timestamp [s] per pose, which is written exactly. Also throws
/// Error(invalid_argument) if the number of timestamps is wrong or a timestamp is not finite.
VIEWGAIN_EXPORT void write_tum(const std::filesystem::path& path, std::span<const Pose> poses,
                               std::span<const double> timestamps);

/// Reads one pose as a row-major 4x4 matrix, with the translation in [m], as in RGB-D data sets.
/// Skips a byte order mark. If orthonormality_error() is between 1e-9 and 1e-2, repairs the
/// rotation; above 1e-5, also sets *orthonormalized to true. Throws Error(format) for a larger
/// error, a last row other than 0 0 0 1 (to 1e-6) or invalid numbers. Throws Error(io) if the path
/// is not a readable regular file, and Error(capacity) above 1 GiB.
[[nodiscard]] VIEWGAIN_EXPORT Pose read_pose_matrix(const std::filesystem::path& path,
                                                    bool* orthonormalized = nullptr);

}  // namespace viewgain
