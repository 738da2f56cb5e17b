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

/// What the numbers of a pose are called: translation [m] and quaternion of T_world_camera.
inline constexpr std::array kPoseColumns{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// What a pose's time [s] is called beside them.
inline constexpr const char* kTimeColumn = "timestamp";

/// These numbers of a pose.
[[nodiscard]] VIEWGAIN_EXPORT std::array<double, kPoseColumns.size()> numbers_of_pose(
    const Pose& pose);

/// The pose of these numbers, or of the 16 of a matrix by rows, all finite. A rotation that is off
/// by 1e-9 to 1e-2 is mended; `mended` says whether. Of a larger error, or a last row that is not
/// 0 0 0 1, `fail` is told, which must throw.
[[nodiscard]] VIEWGAIN_EXPORT Pose
pose_of_numbers(std::span<const double> numbers, bool& mended,
                const std::function<void(const std::string&)>& fail);

/// Throws Error(invalid_argument), naming the file, for poses that no file of poses can hold: not
/// one timestamp per pose, one that is not finite, a pose that is no rigid transform (1e-2).
VIEWGAIN_EXPORT void check_writable(const std::filesystem::path& path, std::span<const Pose> poses,
                                    std::span<const double> timestamps);

}  // namespace viewgain
