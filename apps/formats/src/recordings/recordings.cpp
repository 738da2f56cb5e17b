// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/recordings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "folders.hpp"
#include "recordings/importers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, RecordingFormat>, 3> kMessageFiles{
    {{".mcap", RecordingFormat::mcap},
     {".db3", RecordingFormat::rosbag2},
     {".bag", RecordingFormat::rosbag1}}};

// Determined by the file's first bytes, not by its name.
RecordingFormat file_format(const fs::path& file) {
  const std::string head = file_head(file, 16);
  if (head.starts_with("\x89MCAP0\r\n")) return RecordingFormat::mcap;
  if (head.starts_with("SQLite format 3")) return RecordingFormat::rosbag2;
  if (head.starts_with("#ROSBAG V")) return RecordingFormat::rosbag1;
  if (small_ending(file) == ".json") return RecordingFormat::transforms;
  if (head.starts_with("\x28\xb5\x2f\xfd")) {
    throw Error(ErrorCode::format,
                file.string() + ": the whole file is compressed; unpack it with `unzstd`");
  }
  throw Error(
      ErrorCode::format,
      file.string() + ": the file is not a recording (MCAP, rosbag2, bag, transforms.json)");
}

// Files of one recording in order: NAME_2.mcap comes before NAME_10.mcap.
std::vector<fs::path> message_files(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> files;
  for (const std::string& name : names_in(folder)) {
    if (small_ending(name) == ending) files.push_back(folder / name);
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const std::string one = a.stem().string(), other = b.stem().string();
    return std::pair(one.size(), one) < std::pair(other.size(), other);
  });
  return files;
}

void check(const fs::path& source, const ImportConfig& config) {
  if (config.max_time_gap && !(*config.max_time_gap >= 0)) {
    refuse("the longest time gap is " + short_text(*config.max_time_gap) +
           " s; it must be at least 0");
  }
  if (config.depth_scale && !(*config.depth_scale > 0 && *config.depth_scale <= 1)) {
    refuse("the depth scale is " + short_text(*config.depth_scale) +
           "; it must be between 0 and 1 m per unit");
  }
  if (config.T_body_camera && !config.camera_frame.empty()) {
    refuse("the camera's pose is given twice: by --camera-frame, and for the body of " +
           config.pose_topic + " (--pose-topic)");
  }
  if (config.camera == PinholeCamera{}) return;
  PinholeCamera camera = config.camera;
  if (camera.width == 0 && camera.height == 0) camera.width = camera.height = 1;
  try {
    camera.validate();
  } catch (const Error& error) {
    refuse(source.string() + ": " + error.what());
  }
}

}  // namespace

void require_sensor_for_distortion(const PinholeCamera& camera, const ImportConfig& config) {
  if (config.sensor || !camera.has_distortion()) return;
  refuse("the images have lens distortion, which only a sensor file can describe; give --sensor");
}

void check_recorded_camera(const PinholeCamera& camera) {
  constexpr double kMost = 10;  // sizes of the image
  PinholeCamera sized = camera;
  const bool has_size = camera.width != 0 && camera.height != 0;
  if (!has_size) sized.width = sized.height = 1;
  sized.validate();
  if (!has_size || (std::abs(camera.cx) <= kMost * camera.width &&
                    std::abs(camera.cy) <= kMost * camera.height)) {
    return;
  }
  refuse("camera: the principal point (" + short_text(camera.cx) + ", " + short_text(camera.cy) +
         ") px is far outside the image of " + size_text(camera.width, camera.height) + " px");
}

RecordingFormat recording_format(const fs::path& source) {
  std::error_code ignored;
  if (!fs::is_directory(source, ignored)) {
    if (!is_there(source)) throw Error(ErrorCode::io, source.string() + ": no such file or folder");
    return file_format(source);
  }
  std::vector<std::pair<std::string, RecordingFormat>> found;
  if (is_there(source / "depth.txt") || is_there(source / "groundtruth.txt")) {
    found.emplace_back("depth.txt", RecordingFormat::tum);
  }
  if (is_there(source / "transforms.json")) {
    found.emplace_back("transforms.json", RecordingFormat::transforms);
  }
  for (const auto& [ending, format] : kMessageFiles) {
    if (!message_files(source, ending).empty()) found.emplace_back(ending, format);
  }
  if (found.size() > 1) {
    throw Error(ErrorCode::format, source.string() + ": the folder has recordings of two kinds, " +
                                       found[0].first + " and " + found[1].first +
                                       "; give the file to read");
  }
  if (found.empty()) {
    for (const std::string& name : names_in(source)) {
      if (small_ending(name) == ".zstd") (void)file_format(source / name);
    }
    throw Error(
        ErrorCode::format,
        source.string() +
            ": the folder has no recording (depth.txt, transforms.json, .mcap, .db3 or .bag)");
  }
  return found[0].second;
}

ImportReport import_recording(const fs::path& source, const fs::path& out,
                              const ImportConfig& config) {
  check(source, config);
  const RecordingFormat format = recording_format(source);
  std::error_code ignored;
  const bool is_folder = fs::is_directory(source, ignored);
  if (format == RecordingFormat::tum) return import_tum(source, out, config);
  if (format == RecordingFormat::transforms) {
    return import_transforms(is_folder ? source / "transforms.json" : source, out, config);
  }
  std::vector<fs::path> files{source};
  if (is_folder) {
    for (const auto& [ending, kind] : kMessageFiles) {
      if (kind == format) files = message_files(source, ending);
    }
    for (const fs::path& file : files) {
      refuse_link_out(source, file);
      if (file_format(file) != format) {
        throw Error(ErrorCode::format,
                    file.string() + ": the contents of the file do not match its ending");
      }
    }
  }
  return import_messages(source, files, format, out, config);
}

}  // namespace viewgain
