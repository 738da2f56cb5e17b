// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Recordings of messages, read twice: first what there is, all transforms and the camera, then the
// images, one at a time.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "recordings/depth_image.hpp"
#include "recordings/importers.hpp"
#include "recordings/message_topics.hpp"
#include "recordings/messages.hpp"
#include "recordings/ros_messages.hpp"
#include "recordings/transform_tree.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr double kTransformGap = 0.1;  // between an image and the transforms beside it [s]
constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr const char* kBody = "the body";  // of the topic of poses

std::string seconds_text(std::int64_t stamp) {
  std::string fraction = std::to_string(std::abs(stamp / 1'000'000 % 1000));
  fraction.insert(0, 3 - fraction.size(), '0');
  return std::to_string(stamp / kNanoseconds) + '.' + fraction;
}

class MessageImport {
 public:
  MessageImport(const fs::path& source, const std::vector<fs::path>& files, RecordingFormat format,
                const ImportConfig& config)
      : source_(source), files_(files), format_(format), config_(config) {
    if (report_.world.starts_with('/')) report_.world.erase(0, 1);  // as FieldReader::frame() does
  }

  ImportReport run(const fs::path& out) try {
    read_all([this](const Message& message) { note(message); });
    tree_.finish(warnings_);
    poses_.finish(warnings_);
    if (bad_transforms_ > 0) {
      warnings_.add(std::to_string(bad_transforms_) +
                    " transforms are damaged or not rigid and are left out");
    }
    report_.depth_topic = topics_.chosen_depth_topic(source_, config_.depth_topic);
    const SeenTopic& topic = topics_.all().at(report_.depth_topic);
    choose_camera(topic);
    const bool is_float = topic.encoding == "32FC1";
    scale_ = is_float ? unit_of_floats(topic) : config_.depth_scale.value_or(kMillimetre);
    (void)way_to(topic.frame);  // known before anything is written
    RecordedFolder folder(out);
    read_all([&](const Message& message) {
      if (message.topic.name == report_.depth_topic) take(message, topic, folder);
    });
    say_what_has_no_pose();
    if (stamps_back_ > 0) {
      warnings_.add(std::to_string(stamps_back_) +
                    " images have a stamp before that of an earlier image; the clock was set back, "
                    "or the recording holds two runs");
    }
    if (report_.frames == 0) dropped_.fail_without_frames(source_);
    report_.warnings = warnings_.texts();
    report_.depth_scale = scale_;
    folder.commit(report_.camera, config_.sensor, scale_,
                  is_float ? Sensor::OutOfRange::carve : Sensor::OutOfRange::invalid);
    return std::move(report_);
  } catch (const Error& error) {
    // A file that was read only in part may be the reason.
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
    const bool is_tf = type == kTransformsType || type == kOldTransformsType;
    if (message.topic.encoding == MessageEncoding::other || !is_pose_type(type) ||
        (!is_chosen && !is_tf)) {
      return;
    }
    if (is_chosen && is_tf) {
      throw Error(ErrorCode::format,
                  source_.string() + ": " + message.topic.name + " (" + type +
                      ") holds the transforms of all frames, not the poses of one body; leave out "
                      "--poses and choose the world with --world");
    }
    std::vector<TransformMessage> transforms;
    try {
      transforms = read_transforms(message);
    } catch (const Error&) {
      ++bad_transforms_;
    }
    const bool is_static = message.topic.name.ends_with("tf_static");
    for (const TransformMessage& transform : transforms) {
      const auto& [header, child, numbers] = transform;
      if (is_chosen && body_frame_.empty()) body_frame_ = child;
      if (is_chosen && body_frame_ != child) {
        throw Error(ErrorCode::format,
                    of_message(message, "holds the poses of several bodies, " +
                                            viewgain::quoted(body_frame_) + " and " +
                                            viewgain::quoted(child) +
                                            "; give a topic with one body (--poses)"));
      }
      const bool is_good = is_chosen
                               ? poses_.add(header.frame, kBody, header.stamp, numbers, false)
                               : tree_.add(header.frame, child, header.stamp, numbers, is_static);
      bad_transforms_ += is_good ? 0 : 1;
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
          throw Error(ErrorCode::format, "P must be finite");
        }
      } catch (const Error& error) {
        throw Error(ErrorCode::format, source_.string() + ": the camera_info of " +
                                           report_.depth_topic + ": " + error.what() +
                                           " (--intrinsics)");
      }
      // Of a stereo pair's second camera, whose frame is the first one's.
      if (is_rectified) {
        T_frame_camera_.m[3] = -info->p[3] / info->p[0];
        T_frame_camera_.m[7] = -info->p[7] / info->p[5];
      }
    } else if (config_.sensor) {
      report_.camera = config_.sensor->camera;
      warnings_.add("no camera_info belongs to " + report_.depth_topic +
                    "; using the sensor's intrinsics");
    } else {
      throw Error(ErrorCode::format, source_.string() + ": no camera_info belongs to " +
                                         report_.depth_topic + "; give --intrinsics or --sensor");
    }
    require_sensor_for_distortion(report_.camera, config_);
  }

  // All that the sensor measures, else all that there is up to 65 m, in the finest unit.
  [[nodiscard]] double unit_of_floats(const SeenTopic& topic) const {
    if (config_.depth_scale) return *config_.depth_scale;
    if (config_.sensor) return std::min(depth_scale_for(*config_.sensor), kMillimetre);
    for (const double unit : {kDepthUnit, 2e-4, 5e-4}) {
      if (topic.farthest <= unit * 65534) return unit;
    }
    return kMillimetre;
  }

  // How an image with this frame is found in the world. Throws Error(format).
  const Way& way_to(const std::string& frame) try {
    const auto known = ways_.find(frame);
    if (known != ways_.end()) return known->second;
    const auto fail = [](const std::string& what) -> void { throw Error(ErrorCode::format, what); };
    Way way;
    if (config_.pose_topic.empty()) {
      if (tree_.empty()) {
        fail("has no transforms; record /tf and /tf_static, or give a pose topic with --poses");
      }
      way.moving = tree_.chain(report_.world, frame);
    } else {
      if (poses_.empty()) {
        fail(config_.pose_topic +
             " holds no poses (PoseStamped, PoseWithCovarianceStamped, TransformStamped, "
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
             " does not state the camera's pose on its body; give it after the topic (--poses "
             "TOPIC,tx,ty,tz,qx,qy,qz,qw)");
      }
    }
    if (way.moving.empty()) {
      fail("the frame " + viewgain::quoted(frame) +
           " of the images has no parent, so the camera would never move; record the transform "
           "that leads to it, or choose the world with --world");
    }
    return ways_.emplace(frame, std::move(way)).first->second;
  } catch (const Error& error) {
    throw Error(ErrorCode::format, source_.string() + ": " + error.what());
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
                  "no transforms at " + seconds_text(image.header.stamp) + " s");
    }
    try {
      if (image.encoding != topic.encoding) {
        throw Error(ErrorCode::format, "the encoding " + viewgain::quoted(image.encoding) +
                                           ", not " + viewgain::quoted(topic.encoding) +
                                           " as before");
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
                  "the image has " + size_text(depth.width, depth.height) + " pixels, not " +
                      size_text(camera.width, camera.height));
    }
    if (!is_wrong_order_) is_wrong_order_ = is_wrong_byte_order(image);
    if (is_wrong_order_.value_or(false)) {
      is_wrong_order_ = false;  // said once
      warnings_.add(of_message(message,
                               "the image would be much smoother with its bytes in the other "
                               "order. Is its is_bigendian wrong?"));
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
      T_world_camera = T_world_camera * T_body_camera * T_frame_camera_;
    } catch (const Error&) {  // the first image's frame is connected
    }
    if (found == Found::yes) return true;
    ++without_[static_cast<std::size_t>(found) - 1];
    images_from_ = std::min(images_from_, header.stamp);
    images_to_ = std::max(images_to_, header.stamp);
    return false;
  }

  void say_what_has_no_pose() {
    if (without_ == std::array<std::size_t, 4>{}) return;
    constexpr std::array kWhere{"before the first transform", "after the last one",
                                "in gaps between them (--max-time-gap)", "in unconnected frames"};
    std::string text = "images without a pose:";
    for (std::size_t i = 0; i < kWhere.size(); ++i) {
      if (without_[i] > 0) text += " " + std::to_string(without_[i]) + " " + kWhere[i] + ",";
    }
    text.pop_back();
    const std::array<std::int64_t, 2> span = TransformTree::span_of(ways_.begin()->second.moving);
    if (span[0] > INT64_MIN) {  // else all are static
      text +=
          "; transforms are from " + seconds_text(span[0]) + " to " + seconds_text(span[1]) + " s";
    }
    const bool is_apart =
        report_.frames == 0 && without_[2] + without_[3] == 0 &&
        (images_from_ - 10 * kNanoseconds > span[1] || images_to_ + 10 * kNanoseconds < span[0]);
    if (is_apart) {
      text += ", but images from " + seconds_text(images_from_) + " to " +
              seconds_text(images_to_) + " s; the camera's clock differs from the robot's";
    }
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
  TransformTree tree_, poses_;
  std::string body_frame_;
  std::size_t bad_transforms_ = 0;
  ImportReport report_{.world = config_.world};
  Dropped dropped_{report_.bad};
  double scale_ = kMillimetre;
  Pose T_frame_camera_;
  std::map<std::string, Way> ways_;     // by the images' frame
  std::uint64_t number_ = 0;            // of the image
  std::optional<bool> is_wrong_order_;  // of bytes, by the first image that tells
  std::size_t stamps_back_ = 0;
  std::int64_t last_stamp_ = INT64_MIN, images_from_ = INT64_MAX, images_to_ = INT64_MIN;
  std::array<std::size_t, 4> without_{};  // poses: before, after, in gaps, without a chain
};

}  // namespace

ImportReport import_messages(const fs::path& source, const std::vector<fs::path>& files,
                             RecordingFormat format, const fs::path& out,
                             const ImportConfig& config) {
  if (!config.masks.empty() || !config.confidences.empty()) {
    refuse(
        "a recording of messages has no image files for masks to belong to; give the masks to the "
        "command that reads the imported frames");
  }
  return MessageImport(source, files, format, config).run(out);
}

}  // namespace viewgain
