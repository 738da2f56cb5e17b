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

/// Names of the numbers of a pose: translation [m] and quaternion of T_world_camera.
inline constexpr std::array kPoseColumns{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// Name of a pose's time [s].
inline constexpr const char* kTimeColumn = "timestamp";

/// The numbers of a pose, in the order of kPoseColumns.
[[nodiscard]] VIEWGAIN_EXPORT std::array<double, kPoseColumns.size()> numbers_of_pose(
    const Pose& pose);

/// The pose from these numbers, or from the 16 numbers of a row-major matrix, all finite. Repairs a
/// rotation that deviates by 1e-9 to 1e-2, and then sets `mended`. For a larger deviation, or a
/// last row other than 0 0 0 1, calls `fail`, which must throw.
[[nodiscard]] VIEWGAIN_EXPORT Pose
pose_of_numbers(std::span<const double> numbers, bool& mended,
                const std::function<void(const std::string&)>& fail);

/// Throws Error(invalid_argument), naming the file, for poses that cannot be written: a wrong
/// number of timestamps, one that is not finite, or a pose that is not rigid (1e-2).
VIEWGAIN_EXPORT void check_writable(const std::filesystem::path& path, std::span<const Pose> poses,
                                    std::span<const double> timestamps);

}  // namespace viewgain
