// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/message_topics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "recordings/depth_image.hpp"
#include "recordings/recorded_folder.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr std::array<double, 9> kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1};

auto calibration_of(const CameraInfoMessage& info) {
  return std::tie(info.width, info.height, info.d, info.k, info.p, info.binning, info.roi);
}

// The topic without the transport: "/camera/depth/image_raw" for
// "/camera/depth/image_raw/compressedDepth".
std::string image_topic(std::string topic) {
  constexpr std::string_view kTransport = "/compressedDepth";
  if (topic.ends_with(kTransport)) topic.resize(topic.size() - kTransport.size());
  return topic;
}

// "/camera/depth" of "/camera/depth/image_raw".
std::string namespace_of(const std::string& topic) {
  const std::string name = image_topic(topic);
  return name.substr(0, std::min(name.rfind('/'), name.size()));
}

std::string topic_text(const std::string& name, const SeenTopic& topic) {
  return name + " (" + topic.type + (topic.encoding.empty() ? "" : ", " + topic.encoding) + ", " +
         std::to_string(topic.messages) + " messages)";
}

}  // namespace

void MessageTopics::note(const Message& message) {
  SeenTopic& topic = topics_[message.topic.name];
  topic.type = message.topic.type;
  topic.is_read = message.topic.encoding != MessageEncoding::other;
  ++topic.messages;
  if (!topic.is_read) return;
  try {
    if (is_image_type(topic.type)) {
      const DepthMessage image = read_depth(message);
      if (topic.encoding.empty()) topic.encoding = image.encoding, topic.frame = image.header.frame;
      if (image.encoding != "32FC1") return;
      for (const float z : decode_depth(image).z) {
        if (std::isfinite(z)) topic.farthest = std::max(topic.farthest, static_cast<double>(z));
      }
    } else if (topic.type == kCameraInfoType) {
      const CameraInfoMessage info = read_camera_info(message);
      const auto [known, is_new] = infos_.try_emplace(message.topic.name, Info{info});
      const bool is_same = calibration_of(known->second.first) == calibration_of(info);
      known->second.others += is_same ? 0 : 1;
    }
  } catch (const Error& error) {  // images are counted in the second pass
    if (topic.fault.empty() && topic.encoding.empty()) topic.fault = error.what();
  }
}

std::string MessageTopics::chosen_depth_topic(const std::filesystem::path& source,
                                              const std::string& wanted) const {
  const auto fail = [&](const std::string& what) -> void {
    throw Error(ErrorCode::format, source.string() + ": " + what);
  };
  if (!wanted.empty()) {
    const auto found = topics_.find(wanted);
    if (found == topics_.end())
      fail("the recording has no topic " + wanted + " (--depth-topic); topics: " + listed());
    if (depth_likelihood(found->second.encoding) == 0) {
      fail(topic_text(wanted, found->second) + " has no depth images (--depth-topic)");
    }
    return wanted;
  }
  for (const int likelihood : {2, 1}) {
    std::vector<std::string> names, texts;
    for (const auto& [name, topic] : topics_) {
      if (depth_likelihood(topic.encoding) != likelihood) continue;
      const auto raw = topics_.find(image_topic(name));
      const bool is_copy = raw != topics_.end() && raw->first != name &&
                           depth_likelihood(raw->second.encoding) == likelihood;
      if (is_copy) continue;
      names.push_back(name);
      texts.push_back(topic_text(name, topic));
    }
    if (names.size() > 1) {
      fail("several topics have depth images: " + viewgain::listed(texts) +
           "; choose one with --depth-topic");
    }
    if (names.size() == 1) return names.front();
  }
  for (const auto& [name, topic] : topics_) {
    if (!topic.fault.empty() && is_image_type(topic.type))
      fail("the recording has no depth images; " + topic.fault);
  }
  fail(topics_.empty() ? "the recording has no messages"
                       : "no topic has depth images (sensor_msgs/Image of 16UC1, 32FC1 or mono16, "
                         "or compressedDepth); topics: " +
                             listed());
  return {};
}

const CameraInfoMessage* MessageTopics::info_of(const std::string& depth_topic,
                                                const std::string& frame,
                                                Warnings& warnings) const {
  auto chosen = infos_.find(namespace_of(depth_topic) + "/camera_info");
  if (chosen == infos_.end()) {
    const auto has_frame = [&](const auto& info) {
      return info.second.first.header.frame == frame;
    };
    if (std::count_if(infos_.begin(), infos_.end(), has_frame) != 1) return nullptr;
    chosen = std::find_if(infos_.begin(), infos_.end(), has_frame);
    warnings.add("the intrinsics come from " + chosen->first +
                 ", the only camera_info with the images' frame");
  }
  if (chosen->second.others > 0) {
    warnings.add(chosen->first + " changes; " + std::to_string(chosen->second.others) +
                 " messages differ from the first message, which is used for all images");
  }
  return &chosen->second.first;
}

std::string MessageTopics::listed_poses() const {
  std::vector<std::string> names;
  for (const auto& [name, topic] : topics_) {
    if (is_pose_type(topic.type) && !is_tf_type(topic.type)) names.push_back(name);
  }
  return names.empty() ? "" : " (" + viewgain::listed(names) + ")";
}

std::string MessageTopics::listed_infos() const {
  std::vector<std::string> texts;
  for (const auto& [name, info] : infos_) {
    const auto& [header, width, height, model, d, k, r, p, binning, roi] = info.first;
    texts.push_back(name + " (frame " + viewgain::quoted(header.frame) + ", " +
                    size_text(width, height) + " px, --intrinsics " + short_text(k[0]) + "," +
                    short_text(k[4]) + "," + short_text(k[2]) + "," + short_text(k[5]) + ")");
  }
  return texts.empty() ? "none" : viewgain::listed(texts);
}

bool MessageTopics::is_rectified(const std::string& depth_topic, const CameraInfoMessage& info,
                                 Warnings& warnings) {
  const std::string name = depth_topic.substr(namespace_of(depth_topic).size());
  const bool has_distortion =
      std::any_of(info.d.begin(), info.d.end(), [](double value) { return value != 0; });
  // Without distortion, K also holds for rectified images; some drivers send no P.
  const bool is_rectified =
      name.find("rect") != std::string::npos && (has_distortion || info.p[0] != 0);
  if (!is_rectified && has_distortion && name.find("raw") == std::string::npos) {
    warnings.add(
        "the name of " + depth_topic +
        " contains neither raw nor rect. Its images are assumed to be distorted, as camera_info "
        "states");
  }
  if (is_rectified && info.r != kIdentity && info.r != std::array<double, 9>{}) {
    warnings.add("the camera_info of " + depth_topic +
                 " has a rotation R; the images' frame is assumed to be the rectified one");
  }
  return is_rectified;
}

std::string MessageTopics::listed() const {
  constexpr std::size_t kMost = 20;
  std::vector<std::string> texts;
  for (const auto& [name, topic] : topics_) {
    if (texts.size() == kMost) {
      texts.emplace_back("...");
      break;
    }
    texts.push_back(topic_text(name, topic) + (topic.is_read ? "" : " in an unknown encoding"));
  }
  return viewgain::listed(texts);
}

}  // namespace viewgain
