// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recordings/field_reader.hpp"
#include "recordings/messages.hpp"
#include "viewgain/core/camera.hpp"

namespace viewgain {

/// sensor_msgs/Image, or sensor_msgs/CompressedImage of the transport compressedDepth.
struct DepthMessage {
  RosHeader header;
  std::string encoding;        ///< "16UC1", "32FC1", "mono16", ...
  bool is_compressed = false;  ///< `data` is a PNG, which contains the size
  std::uint32_t width = 0, height = 0, step = 0;
  bool is_big_endian = false;
  std::array<float, 2> inverse{};  ///< for compressed 32FC1: z = inverse[0] / (value - inverse[1])
  std::string_view data;           ///< inside the message's bytes
};

/// sensor_msgs/CameraInfo.
struct CameraInfoMessage {
  RosHeader header;
  std::uint32_t width = 0, height = 0;
  std::string model;  ///< distortion model
  std::vector<double> d;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::array<std::uint32_t, 2> binning{};
  std::array<std::uint32_t, 4> roi{};  ///< x, y, height, width
};

/// A transform of tf, or a pose in the same form: T_parent_child as tx, ty, tz, qx, qy, qz, qw.
struct TransformMessage {
  RosHeader header;   ///< its frame is the parent
  std::string child;  ///< empty for a PoseStamped
  std::array<double, 7> numbers{};
};

/// Whether read_depth() reads messages of this type.
[[nodiscard]] bool is_image_type(const std::string& type);
/// Whether read_transforms() reads messages of this type.
[[nodiscard]] bool is_pose_type(const std::string& type);
/// Whether this is a type of tf messages.
[[nodiscard]] inline bool is_tf_type(const std::string& type) {
  return type == "tf2_msgs/TFMessage" || type == "tf/tfMessage";
}
inline constexpr const char* kCameraInfoType = "sensor_msgs/CameraInfo";

// Each function throws Error(format), naming file, position and topic, for a message that does not
// match its type.
[[nodiscard]] DepthMessage read_depth(const Message& message);
[[nodiscard]] CameraInfoMessage read_camera_info(const Message& message);
/// Reads TFMessage, TransformStamped, PoseStamped, PoseWithCovarianceStamped or Odometry.
[[nodiscard]] std::vector<TransformMessage> read_transforms(const Message& message);

/// "FILE: byte N: TOPIC: what".
[[nodiscard]] std::string of_message(const Message& message, const std::string& what);

/// The camera of the images: from P for rectified images, else from K and D, adapted to the region
/// of interest and binning. Throws Error(format), without a file, for an uncalibrated camera and
/// for an unsupported distortion model.
[[nodiscard]] PinholeCamera camera_of(const CameraInfoMessage& info, bool is_rectified);

}  // namespace viewgain
