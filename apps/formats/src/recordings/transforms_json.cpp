// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// transforms.json of nerfstudio and instant-ngp, with depth images. Their cameras look along -z,
// their pixel (0, 0) has its corner at (0, 0).
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

// The camera of a file or of a frame in it; nothing for missing keys.
class JsonCamera {
 public:
  JsonCamera(const fs::path& file, const Json& json) : file_(file), json_(json) {}

  [[nodiscard]] std::optional<double> number(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end() || found->is_null()) return std::nullopt;
    if (!found->is_number() || !std::isfinite(found->get<double>())) {
      throw Error(ErrorCode::format, file_.string() + ": " + key + " is not a finite number");
    }
    return found->get<double>();
  }
  [[nodiscard]] std::string text(const char* key) const {
    const auto found = json_.find(key);
    return found != json_.end() && found->is_string() ? found->get<std::string>() : std::string();
  }

  void refuse_models() const {
    const std::string model = text("camera_model");
    const std::set<std::string> known{
        "", "OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL"};
    for (const char* key : {"k4", "k5", "k6", "is_fisheye"}) {
      const auto found = json_.find(key);
      const bool is_set =
          found != json_.end() && !found->is_null() && *found != 0 && *found != Json(false);
      if (!is_set && known.contains(model)) continue;
      throw Error(ErrorCode::format, file_.string() + ": the camera model " +
                                         viewgain::quoted(is_set ? key : model.c_str()) +
                                         " is not supported (pinhole with k1, k2, p1, p2, k3 is)");
    }
  }

  // In pixels of images of w x h, with the first pixel's middle at (0, 0).
  [[nodiscard]] PinholeCamera camera() const {
    refuse_models();
    PinholeCamera camera;
    for (const auto& [key, size] :
         {std::pair("w", &camera.width), std::pair("h", &camera.height)}) {
      const double value = number(key).value_or(0);
      if (value < 0 || value > 16384) {
        throw Error(ErrorCode::format, file_.string() + ": " + key + " is " + short_text(value) +
                                           " px, not within 1 and 16384");
      }
      *size = static_cast<int>(value);
    }
    const auto focal = [&](const char* key, const char* angle, int size) {
      std::optional<double> length = number(key);
      if (!length && number(angle)) length = 0.5 * size / std::tan(0.5 * *number(angle));
      return length;
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
  const fs::path& file_;
  const Json& json_;
};

ReadPose json_pose(const Json& frame, const std::string& where) {
  const auto lost = [&](const std::string& what) {
    return unknown_pose(FrameVerdict::lost_pose, where + ": transform_matrix: " + what);
  };
  const auto matrix = frame.find("transform_matrix");
  if (matrix == frame.end()) {
    return unknown_pose(FrameVerdict::no_pose, where + ": has no transform_matrix");
  }
  std::vector<double> numbers;
  for (const Json& row : *matrix) {
    if (!row.is_array()) return lost("is no matrix");
    for (const Json& value : row) {
      if (!value.is_number() || !std::isfinite(value.get<double>())) return lost("is not finite");
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
  // From y up and -z forward to y down and z forward.
  for (const std::size_t i : {1, 5, 9, 2, 6, 10}) {
    pose.T_world_camera.m[i] = -pose.T_world_camera.m[i];
  }
  return pose;
}

// Images of another size than w x h, such as a phone's depth, show the same field of view.
void scale_to_images(const std::vector<RecordedFrame>& frames, PinholeCamera& camera,
                     std::vector<std::string>& warnings) {
  for (const RecordedFrame& frame : frames) {
    std::array<int, 2> size{};
    try {
      size = png_size(frame.image);
    } catch (const Error&) {
      continue;  // counted where it is read
    }
    const bool has_size = camera.width > 0 && camera.height > 0;
    if (has_size && size != std::array{camera.width, camera.height}) {
      warnings.push_back("depth images of " + size_text(size[0], size[1]) +
                         " px; the intrinsics of " + size_text(camera.width, camera.height) +
                         " px are scaled to them");
      const double x = 1.0 * size[0] / camera.width, y = 1.0 * size[1] / camera.height;
      camera.fx *= x, camera.fy *= y;
      camera.cx = (camera.cx + 0.5) * x - 0.5, camera.cy = (camera.cy + 0.5) * y - 0.5;
    }
    camera.width = size[0], camera.height = size[1];
    return;
  }
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
    fail("is no JSON with a list 'frames'");
  }
  const JsonCamera said(file, json);
  ImportReport report;
  Dropped dropped{report.bad};
  std::vector<RecordedFrame> frames;
  std::set<fs::path> names;
  std::optional<PinholeCamera> of_frames;
  std::uint64_t number = 0;
  for (const Json& frame : json["frames"]) {
    const std::string where = file.string() + ": frame " + std::to_string(number);
    if (!frame.is_object()) fail("frame " + std::to_string(number) + " is no object");
    const JsonCamera own(file, frame);
    std::string image = own.text("depth_file_path");
    if (image.empty()) image = own.text("depth_path");
    if (own.number("fl_x") || own.number("camera_angle_x")) {
      const PinholeCamera camera = own.camera();
      if (of_frames && *of_frames != camera) {
        fail("frame " + std::to_string(number) + " has another camera; one for all is supported");
      }
      of_frames = camera;
    }
    const fs::path inside = path_inside(image);
    ReadPose pose = json_pose(frame, where);
    if (image.empty()) {
      dropped.add({FrameVerdict::unreadable, where + ": names no depth image (depth_file_path)"});
    } else if (inside.empty()) {
      fail("frame " + std::to_string(number) + ": the image " + viewgain::quoted(image) +
           " is outside of the recording");
    } else if (pose.fault.verdict != FrameVerdict::used) {
      dropped.add(pose.fault);
    } else if (!names.insert(inside).second) {
      dropped.add({FrameVerdict::changed, where + ": an earlier frame has named this image"});
    } else {
      refuse_link_out(source, source / inside);
      frames.push_back({number, source / inside, std::move(pose)});
    }
    ++number;
  }
  if (number == 0) fail("names no frame");
  if (config.camera.fx > 0) {
    report.camera = config.camera;
  } else {
    report.camera = of_frames ? *of_frames : said.camera();
    scale_to_images(frames, report.camera, report.warnings);
    if (report.camera.fx == 0) fail("has no focal length (fl_x); give --intrinsics");
  }
  require_sensor_for_distortion(report.camera, config);
  const double scale = config.depth_scale.value_or(
      said.number("integer_depth_scale")
          .value_or(said.number("depth_unit_scale_factor").value_or(kRecordedDepthUnit)));
  if (!(scale > 0 && scale <= 1)) {
    fail("the depth scale " + short_text(scale) + " is not within 0 and 1 m per unit");
  }
  import_images(source, frames, scale, config, out, dropped, report);
  return report;
}

}  // namespace viewgain
