// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "recordings/messages.hpp"
#include "recordings/ros_messages.hpp"

namespace viewgain {

/// A topic as found in the first pass.
struct SeenTopic {
  std::string type;
  std::size_t messages = 0;
  std::string encoding, frame;  ///< of the first image
  double farthest = 0;          ///< largest finite depth of 32FC1 images [m]
  bool is_read = true;          ///< whether its messages can be read: ROS 1 or CDR
  std::string fault{};          ///< why its first image cannot be read
};

/// The topics of a recording: finds the depth images and their camera.
class MessageTopics {
 public:
  /// Takes a message of any type; damaged ones are only counted.
  void note(const Message& message);

  [[nodiscard]] const std::map<std::string, SeenTopic>& all() const noexcept { return topics_; }

  /// `wanted`, or if empty the only topic with depth images. Ignores compressed copies of other
  /// images. Throws Error(format), naming the recording and the topics, if there is none or there
  /// are several.
  [[nodiscard]] std::string chosen_depth_topic(const std::filesystem::path& source,
                                               const std::string& wanted) const;

  /// The first CameraInfo for the images: from the topic camera_info in the same namespace, else
  /// from the only topic with the same frame; null if there is none.
  [[nodiscard]] const CameraInfoMessage* info_of(const std::string& depth_topic,
                                                 const std::string& frame,
                                                 Warnings& warnings) const;

  /// " (/odom, /pose)" of the topics with the poses of one body; empty if there are none.
  [[nodiscard]] std::string listed_poses() const;

  /// "/calib/camera_info (frame 'lens', 640x480 px, --intrinsics 600,600,319.5,239.5)", or "none".
  [[nodiscard]] std::string listed_infos() const;

  /// Whether images are rectified: the topic's name then contains "rect". Warns if the name may
  /// mislead.
  [[nodiscard]] static bool is_rectified(const std::string& depth_topic,
                                         const CameraInfoMessage& info, Warnings& warnings);

  /// "/tf (tf2_msgs/TFMessage, 12), ..."
  [[nodiscard]] std::string listed() const;

 private:
  struct Info {
    CameraInfoMessage first;
    std::size_t others = 0;  // number of different ones
  };

  std::map<std::string, SeenTopic> topics_;
  std::map<std::string, Info> infos_;
};

}  // namespace viewgain
