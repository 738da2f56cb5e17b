// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// Names of the seven numbers of a pose: translation [m] and quaternion of T_world_camera.
inline constexpr std::array kPoseColumns{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// Name of the time of a pose [s].
inline constexpr const char* kTimeColumn = "timestamp";

/// The numbers of a pose, in the order of kPoseColumns.
[[nodiscard]] VIEWGAIN_EXPORT std::array<double, kPoseColumns.size()> numbers_of_pose(
    const Pose& pose);

/// The pose from these seven numbers, or from the 16 numbers of a row-major matrix. All must be
/// finite. The rotation may be wrong by up to 1e-2: the norm of the quaternion differs from 1 by
/// this error, or it is orthonormality_error() of the matrix. Repairs such rotations, and sets
/// `mended` if the error exceeds 1e-5. Calls `fail`, which must throw, for a larger error or a last
/// row other than 0 0 0 1.
[[nodiscard]] VIEWGAIN_EXPORT Pose
pose_of_numbers(std::span<const double> numbers, bool& mended,
                const std::function<void(const std::string&)>& fail);

/// Throws Error(invalid_argument), naming the file, if the number of timestamps is wrong, a
/// timestamp is not finite, or a pose is not rigid within 1e-2.
VIEWGAIN_EXPORT void check_writable(const std::filesystem::path& path, std::span<const Pose> poses,
                                    std::span<const double> timestamps);

}  // namespace viewgain
