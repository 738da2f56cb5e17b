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
/// Poses in text files, T_world_camera. Each call reads or writes the file once, with O(poses) time
/// and memory.

namespace viewgain {

class LineReader;

/// Poses of a file, and the number of repaired ones.
struct VIEWGAIN_EXPORT PoseList {
  std::vector<Pose> poses;         ///< T_world_camera, in file order
  std::vector<double> timestamps;  ///< [s], one per pose
  /// Number of poses whose rotation (norm of the quaternion) deviated by more than 1e-5 and was
  /// repaired.
  std::size_t orthonormalized = 0;
};

/// Reads the TUM format: one pose per line, "timestamp tx ty tz qx qy qz qw" ([s], [m], quaternion
/// of T_world_camera). Skips empty lines, lines that begin with # and a byte order mark. Normalises
/// a quaternion whose norm is within 1e-2 of 1. Throws Error(io) if the file cannot be read,
/// Error(capacity) above 1 GiB, and Error(format) with file and line for other faults and for a
/// file without poses.
[[nodiscard]] VIEWGAIN_EXPORT PoseList read_tum(const std::filesystem::path& path);

/// Reads the pose in the current line of the reader, for files that are still being written. Sets
/// *orthonormalized if the norm of the quaternion deviated by more than 1e-5. Throws Error(format)
/// like read_tum().
[[nodiscard]] VIEWGAIN_EXPORT Pose tum_line_pose(const LineReader& line,
                                                 bool* orthonormalized = nullptr);

/// Writes the TUM format, one pose per line with 17 significant digits. When read back, rotations
/// agree to 2e-15 and translations exactly. Timestamps are 0, 1, 2, ... Atomic: renames a temporary
/// file. Throws Error(io). Throws Error(invalid_argument) if the name of a regular file does not
/// end in .txt or .tum, or if a rotation deviates by more than 1e-2 or is not finite.
VIEWGAIN_EXPORT void write_tum(const std::filesystem::path& path, std::span<const Pose> poses);
/// As above with one timestamp [s] per pose, written exactly. Also throws Error(invalid_argument)
/// for a wrong number of timestamps or one that is not finite.
VIEWGAIN_EXPORT void write_tum(const std::filesystem::path& path, std::span<const Pose> poses,
                               std::span<const double> timestamps);

/// Reads one row-major 4x4 matrix of T_world_camera [m], 16 numbers, as in RGB-D data sets.
/// Orthonormalises a rotation that deviates by 1e-9 to 1e-2, and sets *orthonormalized above 1e-5.
/// Skips a byte order mark. Throws Error(format) with the file for a larger deviation, a last row
/// other than 0 0 0 1 (to 1e-6) and invalid numbers. Throws Error(io) unless it is a readable
/// regular file, and Error(capacity) above 1 GiB.
[[nodiscard]] VIEWGAIN_EXPORT Pose read_pose_matrix(const std::filesystem::path& path,
                                                    bool* orthonormalized = nullptr);

}  // namespace viewgain
