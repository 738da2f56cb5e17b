// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/frames.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "viewgain/core/atomic_file.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/file_bytes.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/core/text.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFramePrefix = "frame-";
constexpr std::string_view kDepthSuffix = ".depth.png";
constexpr std::string_view kAmplitudeSuffix = ".amplitude.png";
constexpr std::string_view kPoseSuffix = ".pose.txt";
constexpr std::array kFrameSuffixes{kDepthSuffix, kAmplitudeSuffix, kPoseSuffix};
constexpr const char* kPoses = "poses.txt";
constexpr const char* kSensor = "sensor.toml";
constexpr const char* kIntrinsics = "camera-intrinsics.txt";
constexpr const char* kSimulated = "simulated.txt";
constexpr std::array kNames{kPoses, kSensor, kIntrinsics, kSimulated};
constexpr std::string_view kSimulatedText = "frames written by viewgain simulate: ";
constexpr std::uint16_t kOutOfRangeValue = 65535;

std::string frame_name(std::size_t index, std::string_view suffix) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%06zu", index);
  return std::string(kFramePrefix) + number.data() + std::string(suffix);
}

// "000050" of "frame-000050.depth.png"; nothing for other names.
std::optional<std::string> frame_number(const std::string& name, std::string_view suffix) {
  if (!name.starts_with(kFramePrefix) || !name.ends_with(suffix)) return std::nullopt;
  if (name.size() <= kFramePrefix.size() + suffix.size()) return std::nullopt;
  const std::string digits =
      name.substr(kFramePrefix.size(), name.size() - kFramePrefix.size() - suffix.size());
  if (digits.size() > 18 || !std::all_of(digits.begin(), digits.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return std::nullopt;
  }
  return digits;
}

// Images of the folder by their number, as "frame-NNNNNN".
std::map<std::uint64_t, std::string> list_frames(const fs::path& dir) {
  std::map<std::uint64_t, std::string> frames;
  for (const fs::path& name : names_in(dir)) {
    if (const auto digits = frame_number(name.string(), kDepthSuffix)) {
      frames.emplace(std::stoull(*digits), std::string(kFramePrefix) + *digits);
    }
  }
  return frames;
}

// The amplitude image that belongs to a depth image, whether there is one or not.
fs::path amplitude_path(const fs::path& depth_image) {
  std::string name = depth_image.filename().string();
  name.replace(name.size() - kDepthSuffix.size(), kDepthSuffix.size(), kAmplitudeSuffix);
  return depth_image.parent_path() / name;
}

// In units, from 0 to the largest value of an image; 0 for what is no number.
std::uint16_t saturated(double units) {
  constexpr double kMax = std::numeric_limits<std::uint16_t>::max();
  return units > 0 ? static_cast<std::uint16_t>(std::min(std::round(units), kMax))
                   : std::uint16_t{0};
}

// Nine numbers of a 3x3 matrix fx 0 cx / 0 fy cy / 0 0 1.
void apply_intrinsics_file(const fs::path& path, PinholeCamera& camera) {
  const std::string bytes = file_bytes(path);
  std::vector<double> k;
  for (LineReader lines(path.string(), bytes); lines.next();) {
    for (std::size_t i = 0; i < lines.words().size(); ++i) k.push_back(lines.finite_number(i));
  }
  if (k.size() != 9) {
    throw Error(ErrorCode::format, path.string() +
                                       ": needs the nine numbers of a 3x3 matrix, has " +
                                       std::to_string(k.size()));
  }
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    throw Error(ErrorCode::format,
                path.string() + ": must have the form fx 0 cx, 0 fy cy, 0 0 1 (no skew)");
  }
  camera.fx = k[0];
  camera.cx = k[2];
  camera.fy = k[4];
  camera.cy = k[5];
  try {
    camera.validate();
  } catch (const Error& error) {
    throw Error(ErrorCode::format, path.string() + ": " + error.what());
  }
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
    bool is_own = count > 0 && name != kIntrinsics && !name.ends_with(kPoseSuffix);
    for (const std::string_view suffix : {kDepthSuffix, kAmplitudeSuffix}) {
      const auto digits = frame_number(name, suffix);
      if (digits) is_own = is_own && std::stoull(*digits) < count;
    }
    if (!is_own) {
      throw Error(ErrorCode::invalid_argument, (dir / file).string() + ": no frames of simulate (" +
                                                   kSimulated +
                                                   " says which are); choose another folder");
    }
  }
  return files;
}

void open_own_layout(const fs::path& dir, FrameSequence& frames) {
  PoseList list = read_tum(dir / kPoses);
  const auto on_disk = list_frames(dir);
  if (on_disk.size() > list.poses.size()) {
    throw Error(ErrorCode::format, (dir / kPoses).string() + ": has " +
                                       std::to_string(list.poses.size()) + " poses for " +
                                       std::to_string(on_disk.size()) + " frames");
  }
  for (std::size_t i = 0; i < list.poses.size(); ++i) {
    frames.images.push_back(dir / frame_name(i, kDepthSuffix));
    if (!is_there(frames.images.back())) {
      throw Error(ErrorCode::io, frames.images.back().string() + ": no such file, poses.txt has " +
                                     std::to_string(list.poses.size()) + " poses");
    }
  }
  frames.poses = std::move(list.poses);
  frames.orthonormalized = list.orthonormalized;
}

void open_recorded_layout(const fs::path& dir, FrameSequence& frames) {
  frames.recorded = true;
  for (const auto& [number, name] : list_frames(dir)) {
    bool mended = false;
    frames.images.push_back(dir / (name + std::string(kDepthSuffix)));
    frames.poses.push_back(read_pose_matrix(dir / (name + std::string(kPoseSuffix)), &mended));
    frames.orthonormalized += mended ? 1 : 0;
  }
  if (frames.images.empty()) {
    throw Error(ErrorCode::io, dir.string() + ": no poses.txt and no frame-NNNNNN.depth.png");
  }
  if (is_there(dir / kIntrinsics)) {
    apply_intrinsics_file(dir / kIntrinsics, frames.sensor.camera);
  }
}

}  // namespace

FrameSequence open_frames(const fs::path& dir, const std::string& sensor,
                          std::optional<double> depth_scale) {
  std::error_code ignored;
  if (!fs::is_directory(dir, ignored)) {
    throw Error(ErrorCode::io, dir.string() + ": no such folder");
  }
  const bool has_sensor = is_there(dir / kSensor);
  FrameSequence frames;
  const bool has_poses = is_there(dir / kPoses);
  frames.depth_scale =
      depth_scale.value_or(has_sensor && has_poses ? kDepthUnit : kRecordedDepthUnit);
  if (!(frames.depth_scale > 0) || !std::isfinite(frames.depth_scale)) {
    throw Error(ErrorCode::invalid_argument, "the depth scale " + short_text(frames.depth_scale) +
                                                 " must be positive and finite");
  }
  if (sensor.empty() && !has_sensor) {
    throw Error(ErrorCode::invalid_argument,
                dir.string() + ": has no sensor.toml, so a sensor is needed");
  }
  frames.sensor = sensor.empty() ? read_sensor_toml(dir / kSensor) : load_sensor(sensor);
  if (has_poses) {
    open_own_layout(dir, frames);
  } else {
    open_recorded_layout(dir, frames);
  }
  return frames;
}

DepthFrame load_frame(const FrameSequence& frames, std::size_t index, OutOfRangeMeaning meaning) {
  if (index >= frames.images.size()) {
    throw Error(ErrorCode::invalid_argument, "there is no frame " + std::to_string(index) + " of " +
                                                 std::to_string(frames.images.size()));
  }
  const PinholeCamera& camera = frames.sensor.camera;
  const GrayImage image = read_gray_png(frames.images[index], camera.width, camera.height);
  const float out_of_range =
      meaning == OutOfRangeMeaning::carve ? DepthFrame::kOutOfRange : DepthFrame::kInvalid;
  DepthFrame frame{image.width, image.height, {}};
  frame.depth.reserve(image.pixels.size());
  for (const std::uint16_t value : image.pixels) {
    frame.depth.push_back(
        value == kOutOfRangeValue ? out_of_range : static_cast<float>(value * frames.depth_scale));
  }
  const fs::path amplitude = amplitude_path(frames.images[index]);
  if (!is_there(amplitude)) return frame;
  for (const std::uint16_t value : read_gray_png(amplitude, camera.width, camera.height).pixels) {
    frame.amplitude.push_back(static_cast<float>(value * kAmplitudeUnit));
  }
  return frame;
}

std::vector<fs::path> frame_files(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const fs::path& name : names_in(dir)) {
    const bool is_frames = std::any_of(
        kFrameSuffixes.begin(), kFrameSuffixes.end(),
        [&](std::string_view suffix) { return frame_number(name.string(), suffix).has_value(); });
    if (is_frames || std::find(kNames.begin(), kNames.end(), name.string()) != kNames.end()) {
      files.push_back(name);
    }
  }
  return files;
}

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
  if (sensor.camera.width != width_ || sensor.camera.height != height_) {
    throw Error(ErrorCode::invalid_argument, "frames of " + std::to_string(width_) + " x " +
                                                 std::to_string(height_) + " px for a sensor of " +
                                                 std::to_string(sensor.camera.width) + " x " +
                                                 std::to_string(sensor.camera.height) + " px");
  }
  write_tum(staged_.path() / kPoses, poses);
  write_sensor_toml(staged_.path() / kSensor, sensor);
  write_file_atomically(staged_.path() / kSimulated,
                        std::string(kSimulatedText) + std::to_string(poses.size()) + "\n");
  staged_.commit(earlier_);
}

}  // namespace viewgain
