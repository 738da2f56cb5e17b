// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/frames.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "frames/frame_names.hpp"
#include "frames/frames_toml.hpp"
#include "frames/pose_match.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/support/toml_table.hpp"

namespace viewgain {
namespace {

template <typename Value>
std::uint64_t apply(const Gray8Image& mask, int width, int height, std::vector<Value>& depth) {
  if (mask.width != width || mask.height != height || mask.pixels.size() != depth.size()) {
    refuse("the mask has " + std::to_string(mask.width) + " x " + std::to_string(mask.height) +
           " px, but the image has " + std::to_string(width) + " x " + std::to_string(height) +
           " px");
  }
  std::uint64_t removed = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (mask.pixels[i] == 0) continue;
    removed += depth[i] != Value{0} ? 1 : 0;
    depth[i] = Value{0};
  }
  return removed;
}

namespace fs = std::filesystem;

constexpr std::uint16_t kFullScale = 65535;

void check_index(std::size_t index, std::size_t count) {
  if (index < count) return;
  refuse("frame " + std::to_string(index) + " does not exist; the number of frames is " +
         std::to_string(count));
}

// Reads the numbers of a 3x3 matrix, on any lines.
void apply_intrinsics_file(const fs::path& path, PinholeCamera& camera) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::format, path.string() + ": " + what);
  };
  const std::string bytes = folder_file_bytes(path);
  std::vector<double> k;
  for (LineReader line(path.string(), bytes); line.next();) {
    for (std::size_t i = 0; i < line.words().size(); ++i) k.push_back(line.finite_number(i));
  }
  if (k.size() != 9) {
    refuse("expected the nine numbers of a 3x3 matrix; found " + std::to_string(k.size()));
  }
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    refuse("the matrix must have the form fx 0 cx, 0 fy cy, 0 0 1 (no skew)");
  }
  camera.fx = k[0], camera.cx = k[2];
  camera.fy = k[4], camera.cy = k[5];
  try {
    camera.validate();
  } catch (const Error& error) {
    refuse(error.what());
  }
}

// Metres per unit of the images, if the folder states it.
std::optional<double> said_scale(const fs::path& dir) {
  const fs::path path = dir / kScale;
  if (!is_there(path)) return std::nullopt;
  const std::string bytes = folder_file_bytes(path);
  LineReader line(path.string(), bytes);
  if (!line.next() || line.words().size() != 1) {
    throw Error(ErrorCode::format, path.string() + ": expected one number, the metres per unit");
  }
  const double scale = line.finite_number(0);
  if (!(scale > 0)) line.fail("the scale " + short_text(scale) + " is not positive");
  return scale;
}

// Uses the current sensor, which can differ from the one at opening.
void correct_ranges(const FrameSequence& frames, DepthFrame& frame) {
  const Sensor& sensor = frames.sensor;
  const RangeCorrector* made = frames.corrector.get();
  if (made != nullptr && made->camera() == sensor.camera &&
      made->calibration() == sensor.range_calibration) {
    made->correct(frame);
  } else {
    sensor.range_calibration.correct(sensor.camera, frame);
  }
}

void add_frame(FrameSequence& frames, fs::path image, ReadPose pose) {
  frames.images.push_back(std::move(image));
  frames.poses.push_back(pose.T_world_camera);
  frames.pose_faults.push_back(std::move(pose.fault));
  frames.orthonormalized += pose.is_mended ? 1 : 0;
}

// Lists one frame per line of poses.txt, with or without an image, and the images without a line.
void list_own_layout(const fs::path& dir, FrameSequence& frames) {
  TimedPoses lines = read_pose_lines(dir / kPoses);
  std::map<std::uint64_t, std::string> names = list_frames(names_in(dir));
  std::vector<std::uint64_t> numbers;
  for (const auto& [number, name] : names) numbers.push_back(number);
  const PoseMatch match = match_poses(dir, lines, numbers, read_frames_toml(dir));
  for (std::size_t i = 0; i < lines.poses.size(); ++i) {
    if (const auto number = match.number_of(i)) names.try_emplace(*number, frame_name(*number, ""));
  }
  for (const auto& [number, name] : names) {
    const std::optional<std::size_t> line = match.line_of(number);
    add_frame(frames, dir / (name + std::string(kDepthSuffix)),
              line ? lines.poses[*line]
                   : unknown_pose(FrameVerdict::no_pose,
                                  (dir / kPoses).string() + ": " + match.no_pose_text(name)));
  }
}

void list_recorded_layout(const fs::path& dir, FrameSequence& frames) {
  for (const auto& [number, name] : list_frames(names_in(dir))) {
    add_frame(frames, dir / (name + std::string(kDepthSuffix)),
              read_pose_file(dir / (name + std::string(kPoseSuffix))));
  }
}

FrameFault size_fault(const fs::path& image, const PinholeCamera& camera) {
  const auto size_text = [](int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
  };
  const auto [width, height] = png_size(image);
  if (width == camera.width && height == camera.height) return {};
  return {FrameVerdict::wrong_size, image.string() + ": the image has " + size_text(width, height) +
                                        " pixels, but the sensor has " +
                                        size_text(camera.width, camera.height)};
}

}  // namespace

MaskFolder::MaskFolder(std::filesystem::path folder, std::optional<std::uint8_t> least_confidence)
    : folder_(std::move(folder)), least_confidence_(least_confidence) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder_, ignored)) {
    throw Error(ErrorCode::io, folder_.string() + ": no such folder");
  }
}

void MaskFolder::require_mask_of_any(const std::vector<std::filesystem::path>& images) const {
  if (std::any_of(images.begin(), images.end(),
                  [this](const auto& image) { return is_there(file_of(image)); })) {
    return;
  }
  refuse(folder_.string() + ": no mask has the name of a depth image" +
         (images.empty() ? "" : ", for example " + images.front().filename().string()));
}

std::filesystem::path MaskFolder::file_of(const std::filesystem::path& image) const {
  return folder_ / image.filename();
}

std::optional<Gray8Image> MaskFolder::mask_of(const std::filesystem::path& image, int width,
                                              int height) const {
  const std::filesystem::path file = file_of(image);
  if (!is_there(file)) return std::nullopt;
  Gray8Image mask = read_gray8_png(file, width, height);
  if (least_confidence_) {
    for (std::uint8_t& pixel : mask.pixels) pixel = pixel < *least_confidence_ ? 1 : 0;
  }
  return mask;
}

std::uint64_t apply_mask(const Gray8Image& mask, GrayImage& depth) {
  return apply(mask, depth.width, depth.height, depth.pixels);
}

std::uint64_t apply_mask(const Gray8Image& mask, DepthFrame& frame) {
  static_assert(DepthFrame::kInvalid == 0.0F);
  return apply(mask, frame.width, frame.height, frame.depth);
}

FrameSequence open_frame_folder(const fs::path& dir, const std::string& sensor,
                                std::optional<double> depth_scale) {
  std::error_code ignored;
  if (!fs::is_directory(dir, ignored)) {
    throw Error(ErrorCode::io, dir.string() + ": no such folder");
  }
  const bool has_sensor = is_there(dir / kSensor);
  FrameSequence frames;
  const FramesToml said = read_frames_toml(dir);
  frames.recorded = said.recorded.value_or(!is_there(dir / kPoses));
  std::optional<double> scale = depth_scale ? depth_scale : said.depth_scale;
  if (!scale) scale = said_scale(dir);
  // Version 0.1.0 wrote no frames.toml; its simulated.txt identifies viewgain's layout.
  const bool may_be_otherwise = !frames.recorded && !is_there(dir / kSimulated);
  frames.is_scale_assumed = !scale && may_be_otherwise;
  frames.depth_scale = scale.value_or(frames.recorded ? kRecordedDepthUnit : kDepthUnit);
  if (!(frames.depth_scale > 0) || !std::isfinite(frames.depth_scale)) {
    refuse("the depth scale " + short_text(frames.depth_scale) + " must be positive and finite");
  }
  if (frames.depth_scale > 1) {
    throw Error(ErrorCode::format, dir.string() + ": the depth scale " +
                                       short_text(frames.depth_scale) +
                                       " is over 1 m per unit. Is it in units per metre?");
  }
  if (sensor.empty() && !has_sensor) {
    refuse(dir.string() + ": the folder has no sensor.toml; give a sensor");
  }
  const fs::path own = dir / kSensor;
  frames.sensor = sensor.empty()
                      ? parse_sensor_toml(folder_file_bytes(own, kMostTomlBytes), own.string())
                      : load_sensor(sensor);
  if (frames.recorded && is_there(dir / kIntrinsics)) {
    apply_intrinsics_file(dir / kIntrinsics, frames.sensor.camera);
  }
  const auto meaning = said.out_of_range ? said.out_of_range : frames.sensor.out_of_range;
  // In its images 65535 also means depths beyond the largest value.
  const bool may_be_beyond =
      !frames.recorded && frames.sensor.max_range > 65534 * frames.depth_scale;
  frames.is_out_of_range_assumed = !meaning && (may_be_otherwise || may_be_beyond);
  frames.out_of_range =
      meaning.value_or(frames.recorded ? Sensor::OutOfRange::invalid : Sensor::OutOfRange::carve);
  if (!frames.sensor.range_calibration.table.empty()) {
    frames.corrector = std::make_shared<const RangeCorrector>(frames.sensor.camera,
                                                              frames.sensor.range_calibration);
  }
  return frames;
}

FrameSequence open_frames(const fs::path& dir, const std::string& sensor,
                          std::optional<double> depth_scale) {
  FrameSequence frames = open_frame_folder(dir, sensor, depth_scale);
  if (frames.recorded) {
    list_recorded_layout(dir, frames);
  } else {
    list_own_layout(dir, frames);
  }
  if (frames.images.empty()) {
    throw Error(ErrorCode::io,
                dir.string() + ": the folder has no poses.txt and no frame-NNNNNN.depth.png");
  }
  return frames;
}

FrameSequence open_depth_images(const fs::path& dir, const std::string& sensor,
                                std::optional<double> depth_scale) {
  FrameSequence frames = open_frame_folder(dir, sensor, depth_scale);
  for (const auto& [number, name] : list_frames(names_in(dir))) {
    frames.images.push_back(dir / (name + std::string(kDepthSuffix)));
  }
  if (frames.images.empty()) {
    throw Error(ErrorCode::io, dir.string() + ": the folder has no frame-NNNNNN.depth.png");
  }
  return frames;
}

std::string assumed_text(const FrameSequence& frames) {
  if (!frames.is_scale_assumed && !frames.is_out_of_range_assumed) return {};
  std::string keys, values;
  const auto add = [&](const std::string& key, const std::string& value,
                       const std::string& meaning) {
    keys += (keys.empty() ? "" : " and ") + key;
    values += (values.empty() ? "" : ", ") + key + " = " + value + " (" + meaning + ")";
  };
  if (frames.is_scale_assumed) {
    add("depth_scale", short_text(frames.depth_scale), "m per unit of the depth images");
  }
  if (frames.is_out_of_range_assumed) {
    const bool carves = frames.out_of_range == Sensor::OutOfRange::carve;
    add("out_of_range", carves ? "\"carve\"" : "\"invalid\"",
        carves ? "65535: no surface up to max_range" : "65535: no depth");
  }
  return std::string("the folder does not state ") + keys + "; assuming " + values +
         ". If this is wrong, set the keys in " + kFrames;
}

DepthFrame load_frame(const FrameSequence& frames, std::size_t index) {
  check_index(index, frames.images.size());
  const PinholeCamera& camera = frames.sensor.camera;
  const GrayImage image = read_gray_png(frames.images[index], camera.width, camera.height);
  const float out_of_range = frames.out_of_range == Sensor::OutOfRange::carve
                                 ? DepthFrame::kOutOfRange
                                 : DepthFrame::kInvalid;
  DepthFrame frame{image.width, image.height, {}};
  if (index < frames.poses.size()) frame.identity = frame_identity(frames, index);
  frame.depth.reserve(image.pixels.size());
  for (const std::uint16_t value : image.pixels) {
    frame.depth.push_back(value == kFullScale ? out_of_range
                                              : static_cast<float>(value * frames.depth_scale));
  }
  correct_ranges(frames, frame);
  const fs::path amplitude = amplitude_path(frames.images[index]);
  if (!is_there(amplitude)) return frame;
  for (const std::uint16_t value : read_gray_png(amplitude, camera.width, camera.height).pixels) {
    frame.amplitude.push_back(value == kFullScale ? DepthFrame::kSaturated
                                                  : static_cast<float>(value * kAmplitudeUnit));
  }
  return frame;
}

FrameReading read_frame(const FrameSequence& frames, std::size_t index,
                        std::span<const MaskFolder> masks) {
  check_index(index, frames.images.size());
  FrameReading reading;
  if (index < frames.pose_faults.size()) reading.fault = frames.pose_faults[index];
  if (reading.fault.verdict != FrameVerdict::used) return reading;
  const fs::path& image = frames.images[index];
  const PinholeCamera& camera = frames.sensor.camera;
  try {
    std::vector<fs::path> files{image};
    if (is_there(amplitude_path(image))) files.push_back(amplitude_path(image));
    for (const MaskFolder& folder : masks) {
      if (is_there(folder.file_of(image))) files.push_back(folder.file_of(image));
    }
    for (const fs::path& file : files) {
      reading.fault = size_fault(file, camera);
      if (reading.fault.verdict != FrameVerdict::used) return reading;
    }
    reading.frame = load_frame(frames, index);
    for (const MaskFolder& folder : masks) {
      const auto mask = folder.mask_of(image, camera.width, camera.height);
      if (mask) reading.masked_pixels += apply_mask(*mask, reading.frame);
    }
  } catch (const Error& error) {
    reading.fault = {FrameVerdict::unreadable, error.what()};
  }
  return reading;
}

std::string frame_identity(const FrameSequence& frames, std::size_t index) {
  check_index(index, frames.poses.size());
  Hash64 hash;
  const fs::path& image = frames.images[index];
  hash.add_bytes(folder_file_bytes(image));
  if (is_there(amplitude_path(image))) hash.add_bytes(folder_file_bytes(amplitude_path(image)));
  for (const double value : frames.poses[index].m) hash.add_number(value);
  return hash.hex() + ' ' + image.filename().string();
}

std::vector<fs::path> frame_files(const fs::path& dir) {
  std::vector<fs::path> files;
  for (const std::string& name : names_in(dir)) {
    const bool is_frames = std::any_of(
        kFrameSuffixes.begin(), kFrameSuffixes.end(),
        [&](std::string_view suffix) { return frame_number(name, suffix).has_value(); });
    if (is_frames || std::find(kNames.begin(), kNames.end(), name) != kNames.end()) {
      files.emplace_back(name);
    }
  }
  return files;
}

}  // namespace viewgain
