// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Recordings of messages are read twice: first topics, transforms and the camera, then the images,
// one at a time.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "recordings/depth_image.hpp"
#include "recordings/importers.hpp"
#include "recordings/message_topics.hpp"
#include "recordings/messages.hpp"
#include "recordings/missing_poses.hpp"
#include "recordings/ros_messages.hpp"
#include "recordings/transform_tree.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr double kTransformGap = 0.1;      // between an image and the surrounding transforms [s]
constexpr const char* kBody = "the body";  // name for the child of the pose topic

class MessageImport {
 public:
  MessageImport(const fs::path& source, const std::vector<fs::path>& files, RecordingFormat format,
                const ImportConfig& config)
      : source_(source), files_(files), format_(format), config_(config) {
    for (std::string* frame : {&report_.world, &camera_frame_}) {
      if (frame->starts_with('/')) frame->erase(0, 1);  // like FieldReader::frame()
    }
  }

  ImportReport run(const fs::path& out) try {
    read_all([this](const Message& message) { note(message); });
    if (bad_transforms_ > 0) {
      warnings_.add("transforms that are damaged or not rigid are left out: " +
                    std::to_string(bad_transforms_));
    }
    report_.depth_topic = topics_.chosen_depth_topic(source_, config_.depth_topic);
    join_trees();
    tree_.finish(warnings_);
    poses_.finish(warnings_);
    const SeenTopic& topic = topics_.all().at(report_.depth_topic);
    choose_camera(topic);
    const bool is_float = topic.encoding == "32FC1";
    scale_ = is_float ? unit_of_floats(topic) : config_.depth_scale.value_or(kMillimetre);
    warn_of_way(topic.frame, way_to(topic.frame));  // before anything is written
    RecordedFolder folder(out);
    read_all([&](const Message& message) {
      if (message.topic.name == report_.depth_topic) take(message, topic, folder);
    });
    say_what_has_no_pose();
    if (stamps_back_ > 0) {
      warnings_.add("images with an earlier time stamp than the image before them: " +
                    std::to_string(stamps_back_) +
                    ". Either the clock was set back, or the file has two recordings");
    }
    if (report_.frames == 0) dropped_.fail_without_frames(source_);
    report_.warnings = warnings_.texts();
    report_.depth_scale = scale_;
    folder.commit(report_.camera, config_.sensor, scale_,
                  is_float ? Sensor::OutOfRange::carve : Sensor::OutOfRange::invalid);
    return std::move(report_);
  } catch (const Error& error) {
    // The reason may be a file that was read only in part.
    if (warnings_.texts().empty()) throw;
    throw Error(error.code(), std::string(error.what()) + "; " + warnings_.texts().front());
  }

 private:
  // T_world_camera = moving * (mount, or T_body_camera).
  struct Way {
    TransformTree::Chain moving, mount;
    Pose T_body_camera;
  };

  void read_all(const MessageVisitor& visit) {
    for (const fs::path& file : files_) {
      if (format_ == RecordingFormat::mcap) read_mcap(file, visit, warnings_);
      if (format_ == RecordingFormat::rosbag1) read_bag(file, visit, warnings_);
      if (format_ == RecordingFormat::rosbag2) read_db3(file, visit, warnings_);
    }
  }

  // The first pass.
  void note(const Message& message) {
    topics_.note(message);
    const std::string& type = message.topic.type;
    const bool is_chosen = message.topic.name == config_.pose_topic;
    const bool is_tf = is_tf_type(type);
    if (message.topic.encoding == MessageEncoding::other || !is_pose_type(type) ||
        (!is_chosen && !is_tf)) {
      return;
    }
    if (is_chosen && is_tf) {
      throw Error(ErrorCode::format,
                  source_.string() + ": " + message.topic.name + " (" + type +
                      ") has the transforms of all frames, not the poses of one body. Omit "
                      "--pose-topic, and choose the world frame with --world");
    }
    std::vector<TransformMessage> transforms;
    try {
      transforms = read_transforms(message);
    } catch (const Error&) {
      ++bad_transforms_;
    }
    const std::string& name = message.topic.name;
    const bool is_static = name.ends_with("tf_static");
    TransformTree& tree = trees_[name.substr(0, name.rfind('/') + 1)];
    for (const TransformMessage& transform : transforms) {
      const auto& [header, child, numbers] = transform;
      if (is_chosen && body_frame_.empty()) body_frame_ = child;
      if (is_chosen && body_frame_ != child) {
        throw Error(ErrorCode::format,
                    of_message(message, "the topic has the poses of several bodies, " +
                                            viewgain::quoted(body_frame_) + " and " +
                                            viewgain::quoted(child) +
                                            "; choose a topic with one body (--pose-topic)"));
      }
      const bool is_good = is_chosen
                               ? poses_.add(header.frame, kBody, header.stamp, numbers, false)
                               : tree.add(header.frame, child, header.stamp, numbers, is_static);
      bad_transforms_ += is_good ? 0 : 1;
    }
  }

  // Several robots can use the same frame names, each in its own namespace. Transforms of the
  // images' namespace come first, then those of the enclosing namespaces.
  void join_trees() {
    const auto nearness = [&](const auto& tree) {
      return report_.depth_topic.starts_with(tree.first) ? tree.first.size() + 1 : 0;
    };
    const auto is_farther = [&](const auto& a, const auto& b) { return nearness(a) < nearness(b); };
    while (!trees_.empty()) {
      const auto next = std::max_element(trees_.begin(), trees_.end(), is_farther);
      tree_.join(next->second, nearness(*next) > 0);
      trees_.erase(next);
    }
  }

  // Throws Error(format) that names the recording.
  void check_camera_of(const std::string& what) const try {
    check_recorded_camera(report_.camera);
  } catch (const Error& error) {
    throw Error(ErrorCode::format, source_.string() + ": the camera of " + what + ": " +
                                       error.what() + " (--intrinsics)");
  }

  void choose_camera(const SeenTopic& topic) {
    report_.camera = config_.camera;
    if (config_.camera.fx > 0) return;
    const CameraInfoMessage* info = topics_.info_of(report_.depth_topic, topic.frame, warnings_);
    if (info != nullptr) {
      const bool is_rectified = topics_.is_rectified(report_.depth_topic, *info, warnings_);
      try {
        report_.camera = camera_of(*info, is_rectified);
        check_recorded_camera(report_.camera);
        if (!std::isfinite(info->p[3]) || !std::isfinite(info->p[7])) {
          throw Error(ErrorCode::format, "the matrix P must be finite");
        }
      } catch (const Error& error) {
        throw Error(ErrorCode::format, source_.string() + ": the camera_info of " +
                                           report_.depth_topic + ": " + error.what() +
                                           " (--intrinsics)");
      }
      // For the second camera of a stereo pair, whose frame is that of the first.
      if (is_rectified) {
        T_first_camera_.m[3] = -info->p[3] / info->p[0];
        T_first_camera_.m[7] = -info->p[7] / info->p[5];
      }
    } else if (config_.sensor) {
      report_.camera = config_.sensor->camera;
      warnings_.add("no camera_info belongs to " + report_.depth_topic +
                    "; the intrinsics of --sensor are used. To use others, give --intrinsics "
                    "(camera_info of other images: " +
                    topics_.listed_infos() + ")");
    } else {
      throw Error(
          ErrorCode::format,
          source_.string() + ": no camera_info belongs to " + report_.depth_topic +
              "; give --intrinsics (camera_info of other images: " + topics_.listed_infos() + ")");
    }
    require_sensor_for_distortion(report_.camera, config_);
  }

  // The finest unit that covers the sensor's range, or without a sensor all depths up to 65 m.
  [[nodiscard]] double unit_of_floats(const SeenTopic& topic) const {
    if (config_.depth_scale) return *config_.depth_scale;
    if (config_.sensor) return std::min(depth_scale_for(*config_.sensor), kMillimetre);
    for (const double unit : {kDepthUnit, 2e-4, 5e-4}) {
      if (topic.farthest <= unit * 65534) return unit;
    }
    return kMillimetre;
  }

  // The transforms from the world to images with this frame. Throws Error(format).
  const Way& way_to(const std::string& image_frame) try {
    const std::string& frame = camera_frame_.empty() ? image_frame : camera_frame_;
    const auto known = ways_.find(frame);
    if (known != ways_.end()) return known->second;
    const auto fail = [](const std::string& what) -> void { throw Error(ErrorCode::format, what); };
    Way way;
    if (config_.pose_topic.empty()) {
      if (tree_.empty()) {
        fail(
            "the recording has no transforms; record /tf and /tf_static, or give a topic of poses" +
            topics_.listed_poses() + " with --pose-topic");
      }
      way.moving = tree_.chain(report_.world, frame);
    } else {
      if (poses_.empty()) {
        fail(config_.pose_topic +
             " has no poses (PoseStamped, PoseWithCovarianceStamped, TransformStamped, "
             "Odometry); topics: " +
             topics_.listed());
      }
      way.moving = poses_.chain(report_.world, kBody);
      if (config_.T_body_camera) {
        way.T_body_camera = *config_.T_body_camera;
      } else if (!body_frame_.empty()) {
        if (body_frame_ != frame) way.mount = tree_.chain(body_frame_, frame);
      } else if (config_.sensor && config_.sensor->T_flange_camera) {
        way.T_body_camera = *config_.sensor->T_flange_camera;
      } else {
        fail(config_.pose_topic +
             " does not state the camera's pose on the body; give this pose after the topic "
             "(--pose-topic TOPIC,tx,ty,tz,qx,qy,qz,qw)");
      }
    }
    if (way.moving.empty()) {
      fail("the frame " + viewgain::quoted(frame) +
           " of the images has no parent frame, so the camera would never move. Record the "
           "transform to this frame, or choose the world frame with --world");
    }
    return ways_.emplace(frame, std::move(way)).first->second;
  } catch (const Error& error) {
    throw Error(ErrorCode::format, source_.string() + ": " + error.what());
  }

  void warn_of_way(const std::string& frame, const Way& way) {
    if (TransformTree::span_of(way.moving)[0] == INT64_MIN) {
      warnings_.add(
          "the transforms between the world and the camera never change, so all images have the "
          "same pose");
      if (const std::string poses = topics_.listed_poses(); !poses.empty()) {
        warnings_.add("the recording also has topics of poses" + poses +
                      ". They are not used; to use one, give --pose-topic");
      }
    }
    const auto is_optical = [](const std::string& name) {
      return name.find("optical") != std::string::npos;
    };
    const bool is_frame_used = config_.pose_topic.empty() || !way.mount.empty();
    if (!is_frame_used || !camera_frame_.empty() || is_optical(frame)) return;
    for (const std::string& name : tree_.frames()) {
      if (!is_optical(name)) continue;
      warnings_.add("the images' frame " + viewgain::quoted(frame) +
                    " is assumed to be an optical frame (x right, y down, z forward). If the "
                    "optical frame is " +
                    viewgain::quoted(name) + ", give it with --camera-frame");
    }
  }

  // The second pass.
  void take(const Message& message, const SeenTopic& topic, RecordedFolder& folder) {
    const std::uint64_t number = number_++;
    const auto drop = [&](FrameVerdict verdict, const std::string& what) {
      dropped_.add({verdict, of_message(message, what)});
    };
    DepthMessage image;
    DepthImage depth;
    try {
      image = read_depth(message);
    } catch (const Error& error) {
      return dropped_.add({FrameVerdict::unreadable, error.what()});
    }
    stamps_back_ += image.header.stamp < last_stamp_ ? 1 : 0;
    last_stamp_ = image.header.stamp;
    Pose T_world_camera;
    if (!find_pose(image.header, T_world_camera)) {
      return drop(FrameVerdict::no_pose,
                  "there are no transforms at " + seconds_text(image.header.stamp) + " s");
    }
    try {
      if (image.encoding != topic.encoding) {
        throw Error(ErrorCode::format, "the encoding is " + viewgain::quoted(image.encoding) +
                                           ", not " + viewgain::quoted(topic.encoding) +
                                           " as in earlier images");
      }
      depth = decode_depth(image, scale_);
    } catch (const Error& error) {
      return drop(FrameVerdict::unreadable, error.what());
    }
    PinholeCamera& camera = report_.camera;
    if (camera.width == 0 || camera.height == 0) {
      camera.width = depth.width, camera.height = depth.height;
      check_camera_of(message.topic.name);
    }
    if (camera.width != depth.width || camera.height != depth.height) {
      return drop(FrameVerdict::wrong_size,
                  "the image has " + size_text(depth.width, depth.height) +
                      " pixels, but the camera has " + size_text(camera.width, camera.height) +
                      (config_.camera.fx > 0 ? "" : "; give --intrinsics"));
    }
    if (!is_wrong_order_) is_wrong_order_ = is_wrong_byte_order(image);
    if (is_wrong_order_.value_or(false)) {
      is_wrong_order_ = false;  // reported once
      warnings_.add(
          of_message(message,
                     "the bytes of the image seem to be in the wrong order. Is is_bigendian "
                     "wrong?"));
    }
    const GrayImage pixels = gray_image(depth, scale_);
    report_.readings += static_cast<std::uint64_t>(
        std::count_if(pixels.pixels.begin(), pixels.pixels.end(),
                      [](std::uint16_t value) { return value != 0 && value != 65535; }));
    folder.write(number, pixels, T_world_camera);
    ++report_.frames;
    if (config_.progress) config_.progress(number_, topic.messages);
  }

  bool find_pose(const RosHeader& header, Pose& T_world_camera) {
    using Found = TransformTree::Found;
    Found found = Found::unconnected;
    try {
      const Way& way = way_to(header.frame);
      const double gap = std::min(config_.max_time_gap.value_or(kTransformGap), 1e9);
      const auto max_gap = static_cast<std::int64_t>(gap * kNanoseconds);
      Pose T_body_camera = way.T_body_camera;
      found = TransformTree::look_up(way.moving, header.stamp, max_gap, T_world_camera);
      if (found == Found::yes && !way.mount.empty()) {
        found = TransformTree::look_up(way.mount, header.stamp, max_gap, T_body_camera);
      }
      T_world_camera = T_world_camera * T_body_camera * config_.T_frame_camera * T_first_camera_;
    } catch (const Error&) {  // the first image's frame is connected
    }
    if (found == Found::yes) return true;
    missing_.add(found, header.stamp);
    return false;
  }

  void say_what_has_no_pose() {
    if (missing_.empty()) return;
    const std::string text = missing_.text(ways_.begin()->second.moving, report_.frames == 0);
    if (report_.frames == 0) {
      dropped_.fault = text;
    } else {
      warnings_.add(text);
    }
  }

  const fs::path& source_;
  const std::vector<fs::path>& files_;
  RecordingFormat format_;
  const ImportConfig& config_;
  Warnings warnings_;
  MessageTopics topics_;
  std::map<std::string, TransformTree> trees_;  // by namespace of the topics
  TransformTree tree_, poses_;
  std::string body_frame_, camera_frame_ = config_.camera_frame;
  std::size_t bad_transforms_ = 0;
  ImportReport report_{.world = config_.world};
  Dropped dropped_{report_.bad};
  double scale_ = kMillimetre;
  Pose T_first_camera_;
  std::map<std::string, Way> ways_;     // by frame of the images
  std::uint64_t number_ = 0;            // of the current image
  std::optional<bool> is_wrong_order_;  // of bytes, according to the first conclusive image
  std::size_t stamps_back_ = 0;
  std::int64_t last_stamp_ = INT64_MIN;
  MissingPoses missing_;
};

}  // namespace

ImportReport import_messages(const fs::path& source, const std::vector<fs::path>& files,
                             RecordingFormat format, const fs::path& out,
                             const ImportConfig& config) {
  if (!config.masks.empty() || !config.confidences.empty()) {
    refuse(
        "masks cannot be used with a recording of ROS messages, which has no image files; give the "
        "masks to the command that reads the imported frames");
  }
  return MessageImport(source, files, format, config).run(out);
}

}  // namespace viewgain
