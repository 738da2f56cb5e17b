// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "folders.hpp"
#include "frames/frame_names.hpp"
#include "frames/frames_toml.hpp"
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

constexpr double kMax = std::numeric_limits<std::uint16_t>::max();

// 65535 means out of range, so a depth that is too large for the file becomes invalid.
std::uint16_t depth_units(double units) {
  if (std::isinf(units) && units > 0) return static_cast<std::uint16_t>(kMax);
  const double whole = std::round(units);
  return whole > 0 && whole < kMax ? static_cast<std::uint16_t>(whole) : std::uint16_t{0};
}

// Value in units, clamped to that of an image; 0 for NaN.
std::uint16_t saturated(double units) {
  return units > 0 ? static_cast<std::uint16_t>(std::min(std::round(units), kMax))
                   : std::uint16_t{0};
}

// Files of an earlier simulation in the folder, which a new one may replace.
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
      if (digits) is_own = is_own && frame_index(*digits).value_or(count) < count;
    }
    if (is_own) continue;
    refuse((dir / file).string() + ": simulate did not write this file (" + kSimulated +
           " lists its files); choose another folder");
  }
  return files;
}

}  // namespace

double depth_scale_for(const Sensor& sensor) {
  for (const double scale :
       {kDepthUnit, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5}) {
    if (sensor.max_range <= scale * (kMax - 1)) return scale;
  }
  return 1;
}

FramesWriter::FramesWriter(const fs::path& dir, double depth_scale)
    : earlier_(simulated_files(dir)), staged_(dir), depth_scale_(depth_scale) {
  if (!(depth_scale > 0 && depth_scale <= 1)) {
    refuse("the depth scale must be between 0 and 1 m per unit, not " + short_text(depth_scale));
  }
}

void FramesWriter::write_frame(std::size_t index, const DepthFrame& frame) {
  const auto refuse = [&](const std::string& what) {
    viewgain::refuse("frame " + std::to_string(index) + ": " + what);
  };
  const std::size_t pixels =
      frame.width > 0 && frame.height > 0
          ? static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height)
          : 0;
  if (pixels == 0 || frame.depth.size() != pixels ||
      (!frame.amplitude.empty() && frame.amplitude.size() != pixels)) {
    refuse("the frame has " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
           " px, but " + std::to_string(frame.depth.size()) + " depths and " +
           std::to_string(frame.amplitude.size()) + " amplitudes");
  }
  if (index != written_)
    refuse("frames must be written in order; expected frame " + std::to_string(written_));
  if (written_ > 0 && (frame.width != width_ || frame.height != height_)) {
    refuse("the frame differs in size from earlier frames");
  }
  width_ = frame.width, height_ = frame.height;
  ++written_;
  GrayImage image{frame.width, frame.height, {}};
  image.pixels.reserve(frame.depth.size());
  for (const float z : frame.depth) {
    image.pixels.push_back(depth_units(static_cast<double>(z) / depth_scale_));
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
    refuse("one pose per frame and at least one frame are required; poses: " +
           std::to_string(poses.size()) + ", frames: " + std::to_string(written_));
  }
  const PinholeCamera& camera = sensor.camera;
  if (camera.width != width_ || camera.height != height_) {
    refuse("the frames have " + std::to_string(width_) + " x " + std::to_string(height_) +
           " px, but the sensor has " + std::to_string(camera.width) + " x " +
           std::to_string(camera.height) + " px");
  }
  write_tum(staged_.path() / kPoses, poses);
  write_sensor_toml(staged_.path() / kSensor, sensor);
  FramesToml said;
  said.depth_scale = depth_scale_;
  said.out_of_range = sensor.out_of_range.value_or(Sensor::OutOfRange::carve);
  said.recorded = false;
  write_file_atomically(staged_.path() / kFrames, frames_toml(said));
  write_file_atomically(staged_.path() / kSimulated,
                        std::string(kSimulatedText) + std::to_string(poses.size()) + "\n");
  staged_.commit(earlier_);
}

}  // namespace viewgain
