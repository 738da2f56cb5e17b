// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose_io.hpp"

/// @file
/// Pose files of T_world_camera. The name's ending determines the format: .npy for numpy, otherwise
/// TUM text. Each call reads or writes the file once, with O(poses) time and memory.

namespace viewgain {

/// Reads TUM text (read_tum()) or a .npy array: rows with the columns tx, ty, tz, qx, qy, qz, qw
/// and optionally timestamp, or (n, 4, 4) matrices; float64 or float32, C or Fortran order. Default
/// timestamps are 0, 1, 2, ... Throws whatever read_tum() throws; messages about a .npy file name
/// the row.
[[nodiscard]] VIEWGAIN_EXPORT PoseList load_poses(const std::filesystem::path& path);

/// Writes a file for load_poses(): TUM text for .txt and .tum; for .npy rows with timestamp, tx,
/// ty, tz, qx, qy, qz, qw. Throws Error(invalid_argument) with the valid endings for other names of
/// regular files. Also throws whatever write_tum() throws.
VIEWGAIN_EXPORT void save_poses(const std::filesystem::path& path, std::span<const Pose> poses);
/// As above with timestamps [s], one per pose.
VIEWGAIN_EXPORT void save_poses(const std::filesystem::path& path, std::span<const Pose> poses,
                                std::span<const double> timestamps);

/// Explains why save_poses() rejects the name's ending; empty if it is valid. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string fault_of_poses_name(const std::filesystem::path& path);

}  // namespace viewgain
