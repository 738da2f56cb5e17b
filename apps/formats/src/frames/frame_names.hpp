// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/pose.hpp"
#include "viewgain/formats/frames.hpp"

namespace viewgain {

/// open_frames() without images and poses: data common to all frames of a folder.
[[nodiscard]] FrameSequence open_frame_folder(const std::filesystem::path& dir,
                                              const std::string& sensor,
                                              std::optional<double> depth_scale);

/// A pose as read from a file.
struct ReadPose {
  Pose T_world_camera;
  bool is_mended = false;
  FrameFault fault{};

  bool operator==(const ReadPose& other) const {
    return T_world_camera == other.T_world_camera && fault.what == other.fault.what;
  }
};

/// An unknown pose, which is not finite.
[[nodiscard]] ReadPose unknown_pose(FrameVerdict verdict, std::string what);

/// The poses of a TUM file in the order of its lines, including lost ones.
struct TimedPoses {
  std::vector<ReadPose> poses;
  std::vector<double> times;  // one per pose [s]; NaN: the line has none
};

/// Rules for reading lines of a TUM file.
struct PoseLineRules {
  bool whole_lines_alone = false;  ///< omits text after the last line end
  bool allows_heading = false;  ///< treats a first line of words as a lost pose instead of an error
};

/// Throws Error(io) if the file cannot be read, and Error(format) for a heading.
[[nodiscard]] TimedPoses read_pose_lines(const std::filesystem::path& path,
                                         PoseLineRules rules = {});

/// The pose from a file with a 4x4 matrix; no_pose if there is no such file.
[[nodiscard]] ReadPose read_pose_file(const std::filesystem::path& path);

// Names of files in a folder of frames.
inline constexpr std::string_view kFramePrefix = "frame-";
inline constexpr std::string_view kDepthSuffix = ".depth.png";
inline constexpr std::string_view kAmplitudeSuffix = ".amplitude.png";
inline constexpr std::string_view kPoseSuffix = ".pose.txt";
inline constexpr std::array kFrameSuffixes{kDepthSuffix, kAmplitudeSuffix, kPoseSuffix};
inline constexpr const char* kPoses = "poses.txt";
inline constexpr const char* kSensor = "sensor.toml";
inline constexpr const char* kIntrinsics = "camera-intrinsics.txt";
inline constexpr const char* kSimulated = "simulated.txt";
inline constexpr const char* kScale = "depth-scale.txt";
inline constexpr const char* kImported = "imported.txt";
inline constexpr const char* kFrames = "frames.toml";
inline constexpr std::array kNames{kPoses, kSensor,   kIntrinsics, kSimulated,
                                   kScale, kImported, kFrames};

/// "frame-000050.depth.png" of 50 and ".depth.png".
[[nodiscard]] std::string frame_name(std::uint64_t index, std::string_view suffix);

/// "000050" of "frame-000050.depth.png"; nothing for other names.
[[nodiscard]] std::optional<std::string> frame_number(const std::string& name,
                                                      std::string_view suffix);

/// 50 of "000050"; nothing if it needs more than 64 bits.
[[nodiscard]] std::optional<std::uint64_t> frame_index(const std::string& digits);

/// Frames left out, by "frame-NNNNNN": the number that another frame also has, or empty if it needs
/// more than 64 bits.
using FramesLeftOut = std::map<std::string, std::optional<std::uint64_t>>;

/// The depth images among the names in a folder, by number, as "frame-NNNNNN" with any number of
/// digits. If two have the same number, the later name goes to `left_out`, and so do numbers of
/// more than 64 bits. Without `left_out`, throws Error(format) for these.
[[nodiscard]] std::map<std::uint64_t, std::string> list_frames(
    const std::vector<std::string>& names, FramesLeftOut* left_out = nullptr);

/// Name of the amplitude image for a depth image; it need not exist.
[[nodiscard]] std::filesystem::path amplitude_path(const std::filesystem::path& depth_image);

}  // namespace viewgain
