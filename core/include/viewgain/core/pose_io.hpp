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
/// Poses in text files, T_world_camera. Cost: a file is read or written once, O(poses) in time and
/// memory.

namespace viewgain {

class LineReader;

/// Poses of a file and what the reader had to mend.
struct VIEWGAIN_EXPORT PoseList {
  std::vector<Pose> poses;         ///< T_world_camera, in file order
  std::vector<double> timestamps;  ///< [s], one per pose
  /// Poses whose rotation (quaternion's norm) was off by more than 1e-5 and was mended.
  std::size_t orthonormalized = 0;
};

/// Reads the TUM format: one pose per line, "timestamp tx ty tz qx qy qz qw" ([s], [m], quaternion
/// of T_world_camera); empty lines, lines that begin with # and a byte order mark are skipped. A
/// quaternion whose norm is within 1e-2 of 1 is normalised. Throws Error(io) if the file cannot be
/// read and Error(format), naming the file and the line, for anything else that is wrong, also for
/// a file without a pose; Error(capacity) beyond 1 GiB.
[[nodiscard]] VIEWGAIN_EXPORT PoseList read_tum(const std::filesystem::path& path);

/// The pose of the line of that format that the reader stands at, for files of which not all lines
/// are there yet or right. *orthonormalized says whether the quaternion was off by more than 1e-5.
/// Throws Error(format) as read_tum() does for this line.
[[nodiscard]] VIEWGAIN_EXPORT Pose tum_line_pose(const LineReader& line,
                                                 bool* orthonormalized = nullptr);

/// Writes the TUM format, a pose a line in their order, with 17 significant digits, so that reading
/// it back gives the same rotation to 2e-15 and the same translation exactly. Timestamps are 0, 1,
/// 2, ... Atomic: a temporary file is renamed. Throws Error(io), and Error(invalid_argument) for a
/// name that ends neither in .txt nor in .tum (not of pipes and devices), or naming the index of a
/// pose whose rotation is off by more than 1e-2 or not finite.
VIEWGAIN_EXPORT void write_tum(const std::filesystem::path& path, std::span<const Pose> poses);
/// The same with timestamps [s], one a pose, such as read_tum gives, kept exactly. Throws
/// Error(invalid_argument), too, for another count of them or one that is not finite.
VIEWGAIN_EXPORT void write_tum(const std::filesystem::path& path, std::span<const Pose> poses,
                               std::span<const double> timestamps);

/// Reads one 4x4 row-major matrix of T_world_camera [m] (16 numbers, as RGB-D data sets have it). A
/// rotation that is off by 1e-9 to 1e-2 is orthonormalised; *orthonormalized says whether by over
/// 1e-5. A larger error, a last row that is not 0 0 0 1 (1e-6), another count of numbers or a word
/// that is no finite number throws Error(format), naming the file. Throws Error(io) if it is no
/// regular file or cannot be read, Error(capacity) beyond 1 GiB. A byte order mark is skipped.
[[nodiscard]] VIEWGAIN_EXPORT Pose read_pose_matrix(const std::filesystem::path& path,
                                                    bool* orthonormalized = nullptr);

}  // namespace viewgain
