// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// transforms.json of nerfstudio and instant-ngp, with depth images. Their cameras look along -z,
// and the corner of pixel (0, 0) is at (0, 0).
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "folders.hpp"
#include "recordings/importers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/json.hpp"
#include "viewgain/support/pose_numbers.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using app::Json;

constexpr std::uint64_t kMostJsonBytes = std::uint64_t{1} << 28U;

// The camera of a frame. Each key comes from the frame, else from the top of the file; empty if
// missing.
class JsonCamera {
 public:
  JsonCamera(const fs::path& file, const Json& top, const Json& frame)
      : file_(file), levels_{&frame, &top} {}

  [[nodiscard]] std::optional<double> number(const char* key) const {
    const Json* const found = find(key);
    return found == nullptr ? std::nullopt : std::optional(number_of(key, *found));
  }
  [[nodiscard]] std::string text(const char* key) const {
    const Json* const found = find(key);
    return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
  }

  void refuse_models() const {
    const std::string model = text("camera_model");
    const std::set<std::string> known{
        "", "OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL"};
    for (const char* key : {"k4", "k5", "k6", "is_fisheye"}) {
      const Json* const found = find(key);
      const bool is_set = found != nullptr && *found != 0 && *found != Json(false);
      if (!is_set && known.contains(model)) continue;
      throw Error(ErrorCode::format,
                  file_.string() + ": the camera model " +
                      viewgain::quoted(is_set ? key : model.c_str()) +
                      " is not supported (supported: pinhole with k1, k2, p1, p2, k3)");
    }
  }

  // In pixels of images of w x h, else of `image_size`, with the centre of the first pixel at (0,
  // 0).
  [[nodiscard]] PinholeCamera camera(const std::array<int, 2>& image_size) const {
    PinholeCamera camera;
    for (const auto& [key, size] :
         {std::pair("w", &camera.width), std::pair("h", &camera.height)}) {
      const double value = number(key).value_or(0);
      if (value < 0 || value > 16384) {
        throw Error(ErrorCode::format, file_.string() + ": " + key + " is " + short_text(value) +
                                           " px; it must be in 1..16384");
      }
      *size = static_cast<int>(value);
    }
    if ((camera.width == 0) != (camera.height == 0)) {
      throw Error(ErrorCode::format,
                  file_.string() + ": the file has only one of w and h; both are required");
    }
    if (camera.width == 0) camera.width = image_size[0], camera.height = image_size[1];
    // A frame's angle has priority over the file's focal length.
    const auto focal = [&](const char* key, const char* angle, int size) -> std::optional<double> {
      for (const Json* const level : levels_) {
        if (const Json* const length = find(key, *level)) return number_of(key, *length);
        if (const Json* const width = find(angle, *level)) {
          return 0.5 * size / std::tan(0.5 * number_of(angle, *width));
        }
      }
      return std::nullopt;
    };
    const auto fx = focal("fl_x", "camera_angle_x", camera.width);
    const auto fy = focal("fl_y", "camera_angle_y", camera.height);
    camera.fx = fx.value_or(fy.value_or(0)), camera.fy = fy.value_or(fx.value_or(0));
    camera.cx = number("cx").value_or(0.5 * camera.width) - 0.5;
    camera.cy = number("cy").value_or(0.5 * camera.height) - 0.5;
    constexpr std::array kKeys{"k1", "k2", "p1", "p2", "k3"};
    for (std::size_t i = 0; i < kKeys.size(); ++i) {
      camera.distortion[i] = number(kKeys[i]).value_or(0);
    }
    return camera;
  }

 private:
  // Null if the key is missing.
  static const Json* find(const char* key, const Json& level) {
    const auto found = level.find(key);
    return found == level.end() || found->is_null() ? nullptr : &*found;
  }
  [[nodiscard]] const Json* find(const char* key) const {
    const Json* const own = find(key, *levels_[0]);
    return own != nullptr ? own : find(key, *levels_[1]);
  }
  [[nodiscard]] double number_of(const char* key, const Json& value) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      throw Error(ErrorCode::format, file_.string() + ": " + key + " is not a finite number");
    }
    return value.get<double>();
  }

  const fs::path& file_;
  std::array<const Json*, 2> levels_;
};

ReadPose json_pose(const Json& frame, const std::string& where) {
  const auto lost = [&](const std::string& what) {
    return unknown_pose(FrameVerdict::lost_pose, where + ": transform_matrix: " + what);
  };
  const auto matrix = frame.find("transform_matrix");
  if (matrix == frame.end()) {
    return unknown_pose(FrameVerdict::no_pose, where + ": the frame has no transform_matrix");
  }
  std::vector<double> numbers;
  for (const Json& row : *matrix) {
    if (!row.is_array()) return lost("this is not a matrix");
    for (const Json& value : row) {
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        return lost("a number is not finite");
      numbers.push_back(value.get<double>());
    }
  }
  if (numbers.size() == 12) numbers.insert(numbers.end(), {0, 0, 0, 1});
  if (numbers.size() != 16) return lost("is not 4x4");
  ReadPose pose;
  try {
    pose.T_world_camera = pose_of_numbers(numbers, pose.is_mended, [](const std::string& what) {
      throw Error(ErrorCode::format, what);
    });
  } catch (const Error& error) {
    return lost(error.what());
  }
  // Converts from y up and -z forward to y down and z forward.
  for (const std::size_t i : {1, 5, 9, 2, 6, 10}) {
    pose.T_world_camera.m[i] = -pose.T_world_camera.m[i];
  }
  return pose;
}

// Size of the first image that can be read; 0 if there is none.
std::array<int, 2> size_of_images(const std::vector<RecordedFrame>& frames) {
  for (const RecordedFrame& frame : frames) {
    try {
      return png_size(frame.image);
    } catch (const Error&) {  // counted when it is read
    }
  }
  return {};
}

// Images of another size than w x h, such as a phone's depth images, show the same field of view.
void scale_to_images(const std::array<int, 2>& size, PinholeCamera& camera,
                     std::vector<std::string>& warnings) {
  if (size == std::array{camera.width, camera.height}) return;
  warnings.push_back("the depth images have " + size_text(size[0], size[1]) +
                     " px; the intrinsics, which are for " +
                     size_text(camera.width, camera.height) + " px, are scaled accordingly");
  const double x = 1.0 * size[0] / camera.width, y = 1.0 * size[1] / camera.height;
  camera.fx *= x, camera.fy *= y;
  camera.cx = (camera.cx + 0.5) * x - 0.5, camera.cy = (camera.cy + 0.5) * y - 0.5;
  camera.width = size[0], camera.height = size[1];
}

// The common camera of all frames that have a focal length, for images of this size, if known.
// Throws Error(format).
PinholeCamera camera_of_frames(const fs::path& file, const Json& json,
                               const std::array<int, 2>& size) {
  std::optional<PinholeCamera> known;
  std::size_t number = 0;
  for (const Json& frame : json["frames"]) {
    const PinholeCamera camera = JsonCamera(file, json, frame).camera(size);
    if (camera.fx != 0 && known && *known != camera) {
      throw Error(ErrorCode::format,
                  file.string() + ": frame " + std::to_string(number) +
                      " has a different camera; only one camera for all frames is supported");
    }
    if (camera.fx != 0) known = camera;
    ++number;
  }
  if (!known && size[0] > 0) {
    throw Error(ErrorCode::format,
                file.string() + ": the file has no focal length (fl_x); give --intrinsics");
  }
  return known.value_or(PinholeCamera{});
}

}  // namespace

ImportReport import_transforms(const fs::path& file, const fs::path& out,
                               const ImportConfig& config) {
  const fs::path source = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const auto fail = [&](const std::string& what) -> void {
    throw Error(ErrorCode::format, file.string() + ": " + what);
  };
  const Json json = app::parse_or_null(folder_file_bytes(file, kMostJsonBytes));
  if (!json.is_object() || !json.contains("frames") || !json["frames"].is_array()) {
    fail("the file is not JSON with a list 'frames'");
  }
  const JsonCamera said(file, json, json);
  said.refuse_models();
  ImportReport report;
  Dropped dropped{report.bad};
  std::vector<RecordedFrame> frames;
  std::set<fs::path> names;
  std::uint64_t number = 0;
  for (const Json& frame : json["frames"]) {
    const std::string where = file.string() + ": frame " + std::to_string(number);
    if (!frame.is_object()) fail("frame " + std::to_string(number) + " is not an object");
    JsonCamera(file, json, frame).refuse_models();
    const JsonCamera own(file, frame, frame);
    std::string image = own.text("depth_file_path");
    if (image.empty()) image = own.text("depth_path");
    const fs::path inside = path_inside(image);
    ReadPose pose = json_pose(frame, where);
    if (image.empty()) {
      dropped.add(
          {FrameVerdict::unreadable, where + ": the frame has no depth image (depth_file_path)"});
    } else if (inside.empty()) {
      fail("frame " + std::to_string(number) + ": the image " + viewgain::quoted(image) +
           " is outside the recording");
    } else if (pose.fault.verdict != FrameVerdict::used) {
      dropped.add(pose.fault);
    } else if (!names.insert(inside).second) {
      dropped.add({FrameVerdict::changed, where + ": an earlier frame uses the same image"});
    } else {
      refuse_link_out(source, source / inside);
      frames.push_back({number, source / inside, std::move(pose)});
    }
    ++number;
  }
  if (number == 0) fail("the file has no frames");
  if (config.camera.fx > 0) {
    report.camera = config.camera;
  } else {
    const std::array<int, 2> size = size_of_images(frames);
    report.camera = camera_of_frames(file, json, size);
    if (size[0] > 0) {  // otherwise no frame can be used
      scale_to_images(size, report.camera, report.warnings);
      try {
        check_recorded_camera(report.camera);
      } catch (const Error& error) {
        fail(error.what());
      }
    }
  }
  require_sensor_for_distortion(report.camera, config);
  const double scale = config.depth_scale.value_or(
      said.number("integer_depth_scale")
          .value_or(said.number("depth_unit_scale_factor").value_or(kRecordedDepthUnit)));
  if (!(scale > 0 && scale <= 1)) {
    fail("the depth scale " + short_text(scale) + " must be between 0 and 1 m per unit");
  }
  import_images(source, frames, scale, config, out, dropped, report);
  return report;
}

}  // namespace viewgain
