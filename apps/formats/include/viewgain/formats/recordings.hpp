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
/// Recordings of other programs: MCAP, rosbag2 (SQLite), ROS 1 bags, transforms.json of nerfstudio
/// and instant-ngp, and the layout of TUM's RGB-D data sets: depth.txt (timestamp [s] and image per
/// line), groundtruth.txt (TUM poses), 16-bit images in 1/5000 m along z.

namespace viewgain {

/// Formats that import_recording() reads.
enum class RecordingFormat : std::uint8_t { tum, mcap, rosbag2, rosbag1, transforms };

/// Settings of an import.
struct VIEWGAIN_EXPORT ImportConfig {
  /// Intrinsics. Focal lengths of 0 are taken from the recording, else from `sensor`; a size of 0 x
  /// 0 px is taken from the images.
  PinholeCamera camera{};
  /// Largest time between an image and its pose [s]. A pose interpolated between two transforms may
  /// use transforms that are twice as far apart. Empty: 0.02 for TUM's layout, 0.1 for messages.
  std::optional<double> max_time_gap{};
  /// Source of noise and range limits for sensor.toml; empty: none is written.
  std::optional<Sensor> sensor{};
  /// Folder of masks named like the recording's images (see MaskFolder); empty: none.
  std::filesystem::path masks{};
  /// Folder of confidence images, named likewise; empty: none.
  std::filesystem::path confidences{};
  std::uint8_t least_confidence = 1;    ///< least confidence to keep
  std::optional<double> depth_scale{};  ///< metres per unit of 16-bit images; empty: the format's
  std::string world{};        ///< tf frame of the poses; empty: the topmost parent of the images'
                              ///< frame_id
  std::string depth_topic{};  ///< empty: the only topic with depth images
  /// Topic of PoseStamped, PoseWithCovarianceStamped, TransformStamped or Odometry with the pose of
  /// the body that carries the camera; empty: use tf.
  std::string pose_topic{};
  /// Camera pose on the body of pose_topic; empty: from tf (Odometry, TransformStamped), else the
  /// sensor's T_flange_camera.
  std::optional<Pose> T_body_camera{};
  /// tf frame that carries the camera; empty: the images' frame_id, which is its optical frame.
  std::string camera_frame{};
  Pose T_frame_camera{};  ///< camera pose in camera_frame
  /// Called with the number of processed frames and the number of all frames.
  std::function<void(std::size_t, std::size_t)> progress{};
};

/// Result of an import.
struct VIEWGAIN_EXPORT ImportReport {
  std::size_t frames = 0;  ///< number of frames written
  PinholeCamera camera{};  ///< camera of the images
  FrameCounts bad{};  ///< frames left out, by reason: no_pose, lost_pose, unreadable, wrong_size
  /// Number of rotations that deviated from an orthonormal matrix by 1e-9 to 1e-2 and were
  /// repaired.
  std::size_t orthonormalized = 0;
  std::uint64_t readings = 0;       ///< pixels with a depth that were written
  std::uint64_t masked_pixels = 0;  ///< pixels with a depth that were masked out
  std::size_t masks = 0;            ///< frames with a mask or a confidence image
  double depth_scale = 0;           ///< of the written images [m per unit]
  std::string world{};              ///< tf frame of the poses; empty without tf
  std::string depth_topic{};        ///< empty without topics
  /// Warnings about data that was read only in part, and about assumptions.
  std::vector<std::string> warnings{};
};

/// Format of a recording, from the file's first bytes or the folder's contents. Throws Error(io) or
/// Error(format) naming the source if it has none of the formats, or if the folder has two.
[[nodiscard]] VIEWGAIN_EXPORT RecordingFormat recording_format(const std::filesystem::path& source);

/// Writes a recording's frames, numbered from 0, into a folder for open_frames(). The folder
/// appears completely or not at all. apps/docs/reference/formats.md lists formats and messages, and
/// how poses are found. A truncated file is read up to the fault. Throws Error(io) or Error(format)
/// with file and position for faults that affect more than single frames, or if no frame can be
/// used; Error(invalid_argument) for an invalid config or a folder with other frames. Cost:
/// O(bytes), reading messages twice; holds one chunk and all poses in memory.
VIEWGAIN_EXPORT ImportReport import_recording(const std::filesystem::path& source,
                                              const std::filesystem::path& out,
                                              const ImportConfig& config);

}  // namespace viewgain
