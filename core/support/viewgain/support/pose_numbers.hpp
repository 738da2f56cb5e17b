// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>

#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// What the numbers of a pose are called: translation [m] and quaternion of T_world_camera.
inline constexpr std::array kPoseColumns{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// These numbers of a pose.
[[nodiscard]] VIEWGAIN_EXPORT std::array<double, kPoseColumns.size()> numbers_of_pose(
    const Pose& pose);

/// The pose of these numbers, or of the 16 of a matrix by rows, all finite. A rotation that is off
/// by 1e-9 to 1e-2 is mended; `mended` says whether. Of a larger error, or a last row that is not
/// 0 0 0 1, `fail` is told, which must throw.
[[nodiscard]] VIEWGAIN_EXPORT Pose
pose_of_numbers(std::span<const double> numbers, bool& mended,
                const std::function<void(const std::string&)>& fail);

}  // namespace viewgain
