// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "folders.hpp"
#include "frames/frame_names.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSimulatedText = "frames written by viewgain simulate: ";
constexpr std::string_view kImportedText = "# files written by viewgain import";

// In units, from 0 to the largest value of an image; 0 for what is no number.
std::uint16_t saturated(double units) {
  constexpr double kMax = std::numeric_limits<std::uint16_t>::max();
  return units > 0 ? static_cast<std::uint16_t>(std::min(std::round(units), kMax))
                   : std::uint16_t{0};
}

[[noreturn]] void refuse_file(const fs::path& file, const char* what, const char* list) {
  throw Error(ErrorCode::invalid_argument, file.string() + ": no " + what + " (" + list +
                                               " says which are); choose another folder");
}

// Frames must have the camera's size.
void check_size(int width, int height, const PinholeCamera& camera, const char* what) {
  if (camera.width == width && camera.height == height) return;
  throw Error(ErrorCode::invalid_argument, "frames of " + std::to_string(width) + " x " +
                                               std::to_string(height) + " px for a " + what +
                                               " of " + std::to_string(camera.width) + " x " +
                                               std::to_string(camera.height) + " px");
}

// What an earlier simulation left in the folder, which a new one may replace.
std::vector<fs::path> simulated_files(const fs::path& dir) {
  const std::vector<fs::path> files = frame_files(dir);
  if (files.empty()) return files;
  std::size_t count = 0;
  if (is_there(dir / kSimulated)) {
    const std::string text = file_bytes(dir / kSimulated);
    if (text.starts_with(kSimulatedText)) {
      std::from_chars(text.data() + kSimulatedText.size(), text.data() + text.size(), count);
    }
  }
  for (const fs::path& file : files) {
    const std::string name = file.string();
    bool is_own = count > 0 && name != kIntrinsics && name != kScale && name != kImported &&
                  !name.ends_with(kPoseSuffix);
    for (const std::string_view suffix : {kDepthSuffix, kAmplitudeSuffix}) {
      const auto digits = frame_number(name, suffix);
      if (digits) is_own = is_own && std::stoull(*digits) < count;
    }
    if (!is_own) refuse_file(dir / file, "frames of simulate", kSimulated);
  }
  return files;
}

// What an earlier import left in the folder, which a new one may replace.
std::vector<fs::path> imported_files(const fs::path& dir) {
  const std::vector<fs::path> files = frame_files(dir);
  if (files.empty()) return files;
  std::set<std::string> own;
  if (is_there(dir / kImported)) {
    std::istringstream lines(file_bytes(dir / kImported));
    std::string line;
    if (std::getline(lines, line) && line == kImportedText) {
      own.insert(kImported);
      while (std::getline(lines, line)) own.insert(line);
    }
  }
  for (const fs::path& file : files) {
    if (!own.contains(file.string())) refuse_file(dir / file, "file of import", kImported);
  }
  return files;
}

}  // namespace

FramesWriter::FramesWriter(const fs::path& dir) : earlier_(simulated_files(dir)), staged_(dir) {}

void FramesWriter::write_frame(std::size_t index, const DepthFrame& frame) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::invalid_argument, "frame " + std::to_string(index) + ": " + what);
  };
  const std::size_t pixels =
      frame.width > 0 && frame.height > 0
          ? static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height)
          : 0;
  if (pixels == 0 || frame.depth.size() != pixels ||
      (!frame.amplitude.empty() && frame.amplitude.size() != pixels)) {
    refuse(std::to_string(frame.width) + " x " + std::to_string(frame.height) + " px with " +
           std::to_string(frame.depth.size()) + " depths and " +
           std::to_string(frame.amplitude.size()) + " amplitudes");
  }
  if (index != written_) refuse("comes after " + std::to_string(written_) + " frames");
  if (written_ > 0 && (frame.width != width_ || frame.height != height_)) {
    refuse("is of another size than those before");
  }
  width_ = frame.width, height_ = frame.height;
  ++written_;
  GrayImage image{frame.width, frame.height, {}};
  image.pixels.reserve(frame.depth.size());
  for (const float z : frame.depth) {
    image.pixels.push_back(saturated(static_cast<double>(z) / kDepthUnit));
  }
  write_png(staged_.path() / frame_name(index, kDepthSuffix), image);
  if (frame.amplitude.empty()) return;
  image.pixels.clear();
  for (const float amplitude : frame.amplitude) {
    image.pixels.push_back(saturated(static_cast<double>(amplitude) / kAmplitudeUnit));
  }
  write_png(staged_.path() / frame_name(index, kAmplitudeSuffix), image);
}

void FramesWriter::commit(const std::vector<Pose>& poses, const Sensor& sensor) {
  if (poses.size() != written_ || written_ == 0) {
    throw Error(ErrorCode::invalid_argument, std::to_string(poses.size()) + " poses for " +
                                                 std::to_string(written_) + " frames");
  }
  check_size(width_, height_, sensor.camera, "sensor");
  write_tum(staged_.path() / kPoses, poses);
  write_sensor_toml(staged_.path() / kSensor, sensor);
  write_file_atomically(staged_.path() / kSimulated,
                        std::string(kSimulatedText) + std::to_string(poses.size()) + "\n");
  staged_.commit(earlier_);
}

RecordedFramesWriter::RecordedFramesWriter(const fs::path& dir)
    : earlier_(imported_files(dir)), staged_(dir) {}

void RecordedFramesWriter::write_frame(std::uint64_t number, const GrayImage& depth,
                                       const Pose& T_world_camera) {
  const std::string image = frame_name(number, kDepthSuffix);
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::invalid_argument, image + ": " + what);
  };
  if (files_.contains(image)) refuse("is written already");
  if (!files_.empty() && (depth.width != width_ || depth.height != height_)) {
    refuse("is of another size than those before");
  }
  if (!rigid_pose(T_world_camera)) refuse("the pose is no rigid transform");
  const auto& m = T_world_camera.m;
  std::string text;
  for (std::size_t i = 0; i < m.size(); ++i) {
    text += short_text(m[i]) + (i % 4 == 3 ? "\n" : " ");
  }
  const std::string pose = frame_name(number, kPoseSuffix);
  write_png(staged_.path() / image, depth);
  write_file_atomically(staged_.path() / pose, text + "0 0 0 1\n");
  width_ = depth.width, height_ = depth.height;
  files_.insert(image);
  files_.insert(pose);
}

void RecordedFramesWriter::commit(const PinholeCamera& camera, double depth_scale,
                                  const std::optional<Sensor>& sensor) {
  if (files_.empty()) throw Error(ErrorCode::invalid_argument, "there is no frame to write");
  camera.validate();
  check_size(width_, height_, camera, "camera");
  if (!(depth_scale > 0) || !std::isfinite(depth_scale)) {
    throw Error(ErrorCode::invalid_argument,
                "the depth scale " + short_text(depth_scale) + " must be positive and finite");
  }
  const auto put = [this](const char* name, const std::string& text) {
    write_file_atomically(staged_.path() / name, text);
    files_.insert(name);
  };
  put(kIntrinsics, short_text(camera.fx) + " 0 " + short_text(camera.cx) + "\n0 " +
                       short_text(camera.fy) + " " + short_text(camera.cy) + "\n0 0 1\n");
  put(kScale, short_text(depth_scale) + "\n");
  if (sensor) {
    Sensor own = *sensor;
    own.camera = camera;
    own.validate();
    put(kSensor, sensor_toml(own));
  }
  std::string list = std::string(kImportedText) + "\n";
  for (const std::string& file : files_) list += file + "\n";
  write_file_atomically(staged_.path() / kImported, list);
  staged_.commit(earlier_);
}

}  // namespace viewgain
