// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "frames/frame_names.hpp"
#include "viewgain/formats/recordings.hpp"

namespace viewgain {

inline constexpr double kMillimetre = 1e-3;  // [m]

// The formats, a file each. They leave the camera's size, the frames of other sizes and reversed
// rows to open_recording().
[[nodiscard]] Recording open_tum(const std::filesystem::path& source,
                                 const RecordingConfig& config);
[[nodiscard]] Recording open_bop(const std::filesystem::path& source,
                                 const RecordingConfig& config);
[[nodiscard]] Recording open_scannet(const std::filesystem::path& source,
                                     const RecordingConfig& config);
[[nodiscard]] Recording open_icl_nuim(const std::filesystem::path& source,
                                      const RecordingConfig& config);

/// How far off a rotation may be, and from where on it is mended.
inline constexpr double kMendableRotation = 1e-2;
inline constexpr double kUnnoticedRotation = 1e-9;

/// The depth images of TUM and of what is like it [m per unit].
inline constexpr double kTumDepthUnit = 1.0 / 5000;

/// A TUM file's poses, the lost ones among them.
struct TimedPoses {
  std::vector<ReadPose> poses;
  std::vector<double> times;  ///< one a pose [s]; NaN: the line has none
};
/// Throws as read_tum() unless one of them can be used.
[[nodiscard]] TimedPoses read_timed_poses(const std::filesystem::path& path);

/// Puts a frame that has this pose into the recording, or counts it among the dropped.
void add_frame(Recording& recording, std::uint64_t number, const std::filesystem::path& image,
               const ReadPose& pose);
/// Counts a frame among the dropped.
void drop_frame(Recording& recording, const FrameFault& why);

/// The folder's images that are called NUMBER.png, by number. Throws Error(io) if there are none
/// and Error(format), naming the file, for two of one number.
[[nodiscard]] std::map<std::uint64_t, std::filesystem::path> numbered_images(
    const std::filesystem::path& folder);

/// Throws Error(invalid_argument) if the config has a camera: this format has its own.
void refuse_camera(const RecordingConfig& config, const std::filesystem::path& source);

}  // namespace viewgain
