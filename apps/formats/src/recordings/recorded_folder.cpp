// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/recorded_folder.hpp"

#include <sstream>

#include "folders.hpp"
#include "frames/frame_names.hpp"
#include "frames/frames_toml.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImportedText = "# files written by viewgain import";

// Files of an earlier import. A new import may replace them.
std::vector<fs::path> imported_files(const fs::path& dir) {
  const std::vector<fs::path> files = frame_files(dir);
  if (files.empty()) return files;
  std::set<std::string> own;
  if (is_there(dir / kImported)) {
    std::istringstream lines(folder_file_bytes(dir / kImported));
    std::string line;
    if (std::getline(lines, line) && line == kImportedText) {
      own.insert(kImported);
      while (std::getline(lines, line)) own.insert(line);
    }
  }
  for (const fs::path& file : files) {
    if (own.contains(file.string())) continue;
    refuse((dir / file).string() + ": import did not write this file (" + kImported +
           " lists its files); choose another folder");
  }
  return files;
}

}  // namespace

RecordedFolder::RecordedFolder(const fs::path& dir) : earlier_(imported_files(dir)), staged_(dir) {}

void RecordedFolder::write(std::uint64_t number, const GrayImage& depth,
                           const Pose& T_world_camera) {
  const std::string image = frame_name(number, kDepthSuffix);
  write_png(staged_.path() / image, depth);
  files_.insert(image);
  std::string text;
  for (std::size_t i = 0; i < T_world_camera.m.size(); ++i) {
    text += short_text(T_world_camera.m[i]) + (i % 4 == 3 ? "\n" : " ");
  }
  put(frame_name(number, kPoseSuffix), text + "0 0 0 1\n");
}

void RecordedFolder::commit(const PinholeCamera& camera, const std::optional<Sensor>& sensor,
                            double depth_scale, Sensor::OutOfRange out_of_range) {
  put(kIntrinsics, short_text(camera.fx) + " 0 " + short_text(camera.cx) + "\n0 " +
                       short_text(camera.fy) + " " + short_text(camera.cy) + "\n0 0 1\n");
  put(kFrames,
      frames_toml({.depth_scale = depth_scale, .out_of_range = out_of_range, .recorded = true}));
  if (sensor) {
    Sensor own = *sensor;
    own.camera = camera;
    own.validate();
    put(kSensor, sensor_toml(own));
  }
  std::string list = std::string(kImportedText) + "\n";
  for (const std::string& file : files_) list += file + "\n";
  put(kImported, list);
  staged_.commit(earlier_);
}

void RecordedFolder::put(const std::string& name, const std::string& text) {
  write_file_atomically(staged_.path() / name, text);
  files_.insert(name);
}

void Dropped::fail_without_frames(const fs::path& source) const {
  std::string reasons;
  for (const auto& [reason, count] : bad_frames(counts)) {
    reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + ' ' + reason;
  }
  if (!fault.empty()) reasons += "; " + fault;
  throw Error(ErrorCode::format, source.string() + ": no frame can be used (" + reasons + ")");
}

std::string size_text(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace viewgain
