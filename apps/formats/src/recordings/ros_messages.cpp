// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/ros_messages.hpp"

#include <algorithm>
#include <limits>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

constexpr const char* kCompressedType = "sensor_msgs/CompressedImage";

template <typename Parse>
auto read_fields(const Message& message, Parse parse) {
  try {
    FieldReader fields(message.bytes, message.topic.encoding);
    return parse(fields);
  } catch (const Error& error) {
    throw Error(ErrorCode::format, of_message(message, "cannot be read as " + message.topic.type +
                                                           ": " + error.what()));
  }
}

// image_transport's header before the PNG: four bytes, and the quantisation of 32FC1.
void split_compressed(std::string_view bytes, DepthMessage& depth) {
  ByteReader reader(bytes);
  (void)reader.number<std::uint32_t>();
  depth.inverse = reader.number<std::array<float, 2>>();
  depth.data = reader.bytes(reader.left());
  if (!depth.data.starts_with("\x89PNG")) {
    throw Error(
        ErrorCode::format,
        "compressedDepth is only supported as PNG. Record the raw "
        "images, or convert them with `ros2 run image_transport republish compressedDepth raw`");
  }
}

TransformMessage read_transform(FieldReader& fields) {
  TransformMessage transform{fields.header(), fields.frame(), {}};
  transform.numbers = fields.doubles<7>();
  return transform;
}

}  // namespace

std::string of_message(const Message& message, const std::string& what) {
  return message.file.string() + ": " +
         (message.file.extension() == ".db3" ? "message " : "byte ") +
         std::to_string(message.place) + ": " + message.topic.name + ": " + what;
}

bool is_image_type(const std::string& type) {
  return type == "sensor_msgs/Image" || type == kCompressedType;
}

bool is_pose_type(const std::string& type) {
  return is_tf_type(type) || type == "geometry_msgs/TransformStamped" ||
         type == "geometry_msgs/PoseStamped" || type == "geometry_msgs/PoseWithCovarianceStamped" ||
         type == "nav_msgs/Odometry";
}

DepthMessage read_depth(const Message& message) {
  return read_fields(message, [&](FieldReader& fields) {
    DepthMessage depth;
    depth.header = fields.header();
    if (message.topic.type == kCompressedType) {
      const std::string format = fields.text();
      depth.encoding = format.substr(0, format.find(';'));
      depth.is_compressed = true;
      if (format.find("compressedDepth") == std::string::npos) {
        depth.encoding = format.substr(0, 32);  // not a depth image
        return depth;
      }
      split_compressed(fields.blob(), depth);
      return depth;
    }
    depth.height = fields.number<std::uint32_t>();
    depth.width = fields.number<std::uint32_t>();
    depth.encoding = fields.text();
    depth.is_big_endian = fields.number<std::uint8_t>() != 0;
    depth.step = fields.number<std::uint32_t>();
    depth.data = fields.blob();
    return depth;
  });
}

CameraInfoMessage read_camera_info(const Message& message) {
  return read_fields(message, [](FieldReader& fields) {
    CameraInfoMessage info;
    info.header = fields.header();
    info.height = fields.number<std::uint32_t>();
    info.width = fields.number<std::uint32_t>();
    info.model = fields.text();
    info.d = fields.list_of_doubles();
    info.k = fields.doubles<9>();
    info.r = fields.doubles<9>();
    info.p = fields.doubles<12>();
    for (std::uint32_t& value : info.binning) value = fields.number<std::uint32_t>();
    for (std::uint32_t& value : info.roi) value = fields.number<std::uint32_t>();
    return info;
  });
}

std::vector<TransformMessage> read_transforms(const Message& message) {
  const std::string& type = message.topic.type;
  return read_fields(message, [&](FieldReader& fields) {
    std::vector<TransformMessage> transforms;
    if (is_tf_type(type)) {
      const auto count = fields.number<std::uint32_t>();
      for (std::uint32_t i = 0; i < count; ++i) transforms.push_back(read_transform(fields));
    } else if (type == "geometry_msgs/TransformStamped") {
      transforms.push_back(read_transform(fields));
    } else {
      TransformMessage pose{fields.header(), {}, {}};
      if (type == "nav_msgs/Odometry") pose.child = fields.frame();
      pose.numbers = fields.doubles<7>();
      transforms.push_back(pose);
    }
    return transforms;
  });
}

PinholeCamera camera_of(const CameraInfoMessage& info, bool is_rectified) {
  PinholeCamera camera{0, 0, info.k[0], info.k[4], info.k[2], info.k[5], {}};
  if (is_rectified) camera.fx = info.p[0], camera.fy = info.p[5];
  if (is_rectified) camera.cx = info.p[2], camera.cy = info.p[6];
  if (!(camera.fx > 0 && camera.fy > 0)) {
    throw Error(ErrorCode::format, "the camera is not calibrated (its focal length is 0)");
  }
  const auto is_zero = [](double value) { return value == 0; };
  const bool has_distortion = !std::all_of(info.d.begin(), info.d.end(), is_zero);
  if (!is_rectified && has_distortion) {
    const bool is_brown = info.model == "plumb_bob" || info.model == "rational_polynomial";
    const auto five = info.d.begin() + std::min<std::ptrdiff_t>(5, std::ssize(info.d));
    if (!is_brown || !std::all_of(five, info.d.end(), is_zero)) {
      throw Error(ErrorCode::format, "the distortion model " + viewgain::quoted(info.model) +
                                         " with " + std::to_string(info.d.size()) +
                                         " coefficients is not supported; record rectified "
                                         "images (supported: k1, k2, p1, p2, k3)");
    }
    std::copy(info.d.begin(), five, camera.distortion.begin());
  }
  std::array<std::uint32_t, 2> size{info.roi[3] > 0 ? info.roi[3] : info.width,
                                    info.roi[2] > 0 ? info.roi[2] : info.height};
  camera.cx -= info.roi[0], camera.cy -= info.roi[1];
  const std::uint32_t x = std::max(info.binning[0], 1U), y = std::max(info.binning[1], 1U);
  camera.fx /= x, camera.fy /= y;
  // The centre of a binned pixel is the centre of its pixels.
  camera.cx = (camera.cx + 0.5) / x - 0.5, camera.cy = (camera.cy + 0.5) / y - 0.5;
  size[0] /= x, size[1] /= y;
  constexpr std::uint32_t kMost = std::numeric_limits<std::int32_t>::max();
  camera.width = static_cast<int>(std::min(size[0], kMost));
  camera.height = static_cast<int>(std::min(size[1], kMost));
  return camera;
}

}  // namespace viewgain
