// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

/// @file
/// Recordings of others: MCAP, rosbag2 (SQLite), ROS 1 bags, transforms.json of nerfstudio and
/// instant-ngp, and the layout of TUM's RGB-D data sets: depth.txt (timestamp [s] and image per
/// line), groundtruth.txt (TUM poses), 16-bit images in 1/5000 m along z.

namespace viewgain {

/// Kinds of recordings that import_recording() reads.
enum class RecordingFormat : std::uint8_t { tum, mcap, rosbag2, rosbag1, transforms };

/// How a recording is imported.
struct VIEWGAIN_EXPORT ImportConfig {
  /// Focal lengths of 0: as the recording says, else as `sensor`; 0 x 0 px: of the images' size.
  PinholeCamera camera{};
  /// Largest time between an image and its pose, or half of that between the two transforms beside
  /// it [s]; nothing: 0.02 of TUM's layout, 0.1 of messages.
  std::optional<double> max_time_gap{};
  /// Whose noise and range limits sensor.toml is to have; nothing: none is written.
  std::optional<Sensor> sensor{};
  /// Folder of masks by the names of the recording's images (see MaskFolder), empty: none.
  std::filesystem::path masks{};
  /// Folder of confidences likewise.
  std::filesystem::path confidences{};
  std::uint8_t least_confidence = 1;    ///< that counts
  std::optional<double> depth_scale{};  ///< [m] per unit of 16-bit images; nothing: the format's
  std::string world{};        ///< tf frame of the poses; empty: the topmost parent of the images'
  std::string depth_topic{};  ///< empty: the only one with depth images
  /// Topic of PoseStamped, PoseWithCovarianceStamped, TransformStamped or Odometry that gives the
  /// pose of a body that carries the camera; empty: tf does.
  std::string pose_topic{};
  /// The camera on that body; nothing: from tf (Odometry, TransformStamped), else the sensor's
  /// T_flange_camera.
  std::optional<Pose> T_body_camera{};
  /// tf frame that carries the camera; empty: the images' frame_id, which is its optical frame.
  std::string camera_frame{};
  Pose T_frame_camera{};  ///< the camera in that frame
  /// Called with the count of frames done and of all.
  std::function<void(std::size_t, std::size_t)> progress{};
};

/// What an import came to.
struct VIEWGAIN_EXPORT ImportReport {
  std::size_t frames = 0;               ///< that were written
  PinholeCamera camera{};               ///< of their images
  FrameCounts bad{};                    ///< left out: no_pose, lost_pose, unreadable, wrong_size
  std::size_t orthonormalized = 0;      ///< whose rotation was off by 1e-9 to 1e-2 and mended
  std::uint64_t readings = 0;           ///< pixels with a depth that were written
  std::uint64_t masked_pixels = 0;      ///< with a depth, taken away by masks or confidences
  std::size_t masks = 0;                ///< frames that have one or the other
  double depth_scale = 0;               ///< of the images that were written [m per unit]
  std::string world{};                  ///< tf frame of the poses; empty without tf
  std::string depth_topic{};            ///< empty without topics
  std::vector<std::string> warnings{};  ///< what was read only in part, or was assumed
};

/// By the file's first bytes, or what the folder holds. Throws Error(io) or Error(format), naming
/// the source, for other files and for a folder of two kinds.
[[nodiscard]] VIEWGAIN_EXPORT RecordingFormat recording_format(const std::filesystem::path& source);

/// Writes a recording's frames, numbered by their place in it from 0, into a folder that
/// open_frames() reads, which appears whole or not at all. apps/docs/reference/formats.md lists
/// formats and messages, and how poses are found. A cut file is read as far as it goes. Throws
/// Error(io) or Error(format), naming file and place, for what is damaged and not one frame's, or
/// if no frame can be used; Error(invalid_argument) for a bad config or a folder with other frames.
/// Cost: O(bytes); messages are read twice, one chunk and all poses in memory.
VIEWGAIN_EXPORT ImportReport import_recording(const std::filesystem::path& source,
                                              const std::filesystem::path& out,
                                              const ImportConfig& config);

}  // namespace viewgain
