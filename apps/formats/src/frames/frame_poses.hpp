// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"

namespace viewgain {

/// A pose as a file has it.
struct ReadPose {
  Pose T_world_camera;
  bool is_mended = false;
  FrameFault fault{};

  bool operator==(const ReadPose& other) const {
    return T_world_camera == other.T_world_camera && fault.what == other.fault.what;
  }
};

/// A pose that nobody knows: not finite.
[[nodiscard]] ReadPose unknown_pose(FrameVerdict verdict, std::string what);

/// The poses of a TUM file in the order of its lines, the lost ones among them, and where asked
/// for their times [s], NaN where a line has none. `whole_lines_alone`: what comes after the last
/// line's end is left out. Throws Error(io) if it cannot be read.
[[nodiscard]] std::vector<ReadPose> read_pose_lines(const std::filesystem::path& path,
                                                    bool whole_lines_alone = false,
                                                    std::vector<double>* times = nullptr);

/// The pose of a file of a 4x4 matrix; no_pose if there is no such file.
[[nodiscard]] ReadPose read_pose_file(const std::filesystem::path& path);

}  // namespace viewgain
