// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/recordings.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <system_error>

#include "folders.hpp"
#include "frames/frame_names.hpp"
#include "frames/frames_toml.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr double kUnit = 1.0 / 5000;  // of the images [m]
constexpr std::uint16_t kSaturated = 65535;
constexpr const char* kImportedText = "# files written by viewgain import";

TimedPoses read_timed_poses(const fs::path& path) {
  TimedPoses read = read_pose_lines(path, {.allows_heading = true});
  const bool has_any = std::any_of(read.poses.begin(), read.poses.end(), [](const ReadPose& pose) {
    return pose.fault.verdict == FrameVerdict::used;
  });
  if (!has_any) {
    throw Error(ErrorCode::format, read.poses.empty() ? path.string() + ": holds no pose"
                                                      : read.poses.front().fault.what);
  }
  return read;
}

// The pose nearest in time, the first of several; null if it is farther than the gap.
const ReadPose* nearest(const TimedPoses& poses, double time, double gap) {
  const ReadPose* best = nullptr;
  for (std::size_t i = 0; i < poses.times.size(); ++i) {
    const double off = std::abs(poses.times[i] - time);
    if (!(off <= gap)) continue;
    if (best == nullptr || off < gap) best = &poses.poses[i];
    gap = off;
  }
  return best;
}

// A frame that depth.txt names and that has a pose.
struct RecordedFrame {
  std::uint64_t number = 0;  // the place in depth.txt, from 0
  fs::path image;
  ReadPose pose;
};

// Counts those that cannot be used, and keeps the first that a file's contents are to blame for.
struct Dropped {
  FrameCounts& counts;
  std::string fault{};

  void add(const FrameFault& why) {
    ++counts[why.verdict];
    if (fault.empty()) fault = why.what;
  }
};

// A recording may be of anybody, and leads to no files of elsewhere. What is not read may.
void refuse_link_out(const fs::path& source, const fs::path& file) {
  std::error_code ignored;
  const fs::path root = fs::canonical(source, ignored) / "";
  fs::path path = source;
  for (const fs::path& name : file.lexically_relative(source)) {
    path /= name;
    if (!fs::is_symlink(path, ignored)) continue;
    std::error_code code;  // of one that leads nowhere, too
    const std::string to = (fs::canonical(path, code) / "").string();
    if (!code && to.starts_with(root.string())) continue;
    throw Error(ErrorCode::format, path.string() + ": is a link out of the recording");
  }
}

// Masks may lie anywhere, but what lies in the recording may be of anybody, too.
void refuse_mask_link_out(const fs::path& source, const fs::path& mask) {
  const fs::path within = mask.lexically_normal().lexically_relative(source.lexically_normal());
  if (!within.empty() && *within.begin() != "..") refuse_link_out(source, source / within);
}

std::vector<RecordedFrame> read_frames(const fs::path& source, double max_time_gap,
                                       Dropped& dropped) {
  const fs::path list = source / "depth.txt", truth = source / "groundtruth.txt";
  for (const fs::path& file : {list, truth}) refuse_link_out(source, file);
  const std::string bytes = folder_file_bytes(list);
  const TimedPoses poses = read_timed_poses(truth);
  std::vector<RecordedFrame> frames;
  std::set<fs::path> names;
  std::uint64_t number = 0;
  for (LineReader line(list.string(), bytes); line.next();) {
    if (line.words().empty() || line.words().front().front() == '#') continue;
    if (line.words().size() != 2) {
      line.fail("expected a timestamp and an image, found " + std::to_string(line.words().size()) +
                " words");
    }
    // A recording may be of anybody, and names no files of elsewhere.
    const auto image = fs::path(line.words()[1]).lexically_normal();
    if (image.is_absolute() || *image.begin() == "..") {
      line.fail("the image " + quoted(line.words()[1]) + " is outside of the recording");
    }
    const double time = line.finite_number(0);
    const ReadPose* const pose = nearest(poses, time, max_time_gap);
    const std::string where = list.string() + ":" + std::to_string(line.line());
    if (pose == nullptr) {
      dropped.add({FrameVerdict::no_pose, where + ": " + short_text(time) +
                                              " s has no pose within " + short_text(max_time_gap) +
                                              " s (--max-time-gap)"});
    } else if (pose->fault.verdict != FrameVerdict::used) {
      dropped.add(pose->fault);
    } else if (!names.insert(image).second) {
      dropped.add({FrameVerdict::changed, where + ": an earlier line has named this image"});
    } else {
      refuse_link_out(source, source / image);
      frames.push_back({number, source / image, *pose});
    }
    ++number;
  }
  if (number == 0) throw Error(ErrorCode::format, list.string() + ": names no image");
  return frames;
}

// The image, of the camera's size, which the first one gives where the camera has none; else why
// not.
std::optional<GrayImage> read_depth(const fs::path& file, PinholeCamera& camera, Dropped& dropped) {
  try {
    const auto [width, height] = png_size(file);
    if (camera.width == 0) camera.width = width, camera.height = height;
    if (width == camera.width && height == camera.height) {
      GrayImage image = read_gray_png(file, width, height);
      std::replace(image.pixels.begin(), image.pixels.end(), kSaturated, std::uint16_t{0});
      return image;
    }
    const auto size_text = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    dropped.add({FrameVerdict::wrong_size, file.string() + ": the image has " +
                                               size_text(width, height) + " pixels, not " +
                                               size_text(camera.width, camera.height)});
  } catch (const Error& error) {
    dropped.add({FrameVerdict::unreadable, error.what()});
  }
  return std::nullopt;
}

// What an earlier import left in the folder, which a new one may replace.
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
    refuse((dir / file).string() + ": no file of import (" + kImported +
           " says which are); choose another folder");
  }
  return files;
}

// A folder in the recorded layout, which appears, or changes, only when all is written.
class RecordedFolder {
 public:
  explicit RecordedFolder(const fs::path& dir) : earlier_(imported_files(dir)), staged_(dir) {}

  void write(std::uint64_t number, const GrayImage& depth, const Pose& T_world_camera) {
    const std::string image = frame_name(number, kDepthSuffix);
    write_png(staged_.path() / image, depth);
    files_.insert(image);
    std::string text;
    for (std::size_t i = 0; i < T_world_camera.m.size(); ++i) {
      text += short_text(T_world_camera.m[i]) + (i % 4 == 3 ? "\n" : " ");
    }
    put(frame_name(number, kPoseSuffix), text + "0 0 0 1\n");
  }

  void commit(const PinholeCamera& camera, const std::optional<Sensor>& sensor) {
    put(kIntrinsics, short_text(camera.fx) + " 0 " + short_text(camera.cx) + "\n0 " +
                         short_text(camera.fy) + " " + short_text(camera.cy) + "\n0 0 1\n");
    put(kFrames,
        frames_toml(
            {.depth_scale = kUnit, .out_of_range = Sensor::OutOfRange::invalid, .recorded = true}));
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

 private:
  void put(const std::string& name, const std::string& text) {
    write_file_atomically(staged_.path() / name, text);
    files_.insert(name);
  }

  std::vector<fs::path> earlier_;
  StagedFolder staged_;
  std::set<std::string> files_;  // written
};

void check(const fs::path& source, const ImportConfig& config) {
  if (!(config.max_time_gap >= 0)) {
    refuse("the gap of time " + short_text(config.max_time_gap) + " must not be negative");
  }
  PinholeCamera camera = config.camera;
  if (camera.width == 0 && camera.height == 0) camera.width = camera.height = 1;
  try {
    camera.validate();
  } catch (const Error& error) {
    refuse(source.string() + ": " + error.what());
  }
  std::error_code ignored;
  if (!fs::is_directory(source, ignored)) {
    throw Error(ErrorCode::io, source.string() + ": no such folder");
  }
}

}  // namespace

ImportReport import_recording(const fs::path& source, const fs::path& out,
                              const ImportConfig& config) {
  check(source, config);
  ImportReport report;
  report.camera = config.camera;
  Dropped dropped{report.bad};
  const std::vector<RecordedFrame> frames = read_frames(source, config.max_time_gap, dropped);
  std::vector<MaskFolder> mask_folders;
  if (!config.masks.empty()) mask_folders.emplace_back(config.masks);
  if (!config.confidences.empty()) {
    mask_folders.emplace_back(config.confidences, config.least_confidence);
  }
  std::vector<fs::path> images;
  for (const RecordedFrame& frame : frames) images.push_back(frame.image);
  for (const MaskFolder& masks : mask_folders) masks.require_mask_of_any(images);
  RecordedFolder folder(out);
  for (const auto& [number, image, pose] : frames) {
    std::optional<GrayImage> depth = read_depth(image, report.camera, dropped);
    if (!depth) continue;
    bool is_masked = false;
    for (const MaskFolder& masks : mask_folders) {
      refuse_mask_link_out(source, masks.file_of(image));
      std::optional<Gray8Image> mask = masks.mask_of(image, depth->width, depth->height);
      if (!mask) continue;
      is_masked = true;
      report.masked_pixels += apply_mask(*mask, *depth);
    }
    report.masks += is_masked ? 1 : 0;
    report.readings += static_cast<std::uint64_t>(
        std::count_if(depth->pixels.begin(), depth->pixels.end(), [](auto z) { return z != 0; }));
    folder.write(number, *depth, pose.T_world_camera);
    ++report.frames;
    report.orthonormalized += pose.is_mended ? 1 : 0;
    if (config.progress) config.progress(report.frames, frames.size());
  }
  if (report.frames == 0) {
    std::string reasons;
    for (const auto& [reason, count] : bad_frames(report.bad)) {
      reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + ' ' + reason;
    }
    if (!dropped.fault.empty()) reasons += "; " + dropped.fault;
    throw Error(ErrorCode::format, source.string() + ": no frame can be used (" + reasons + ")");
  }
  folder.commit(report.camera, config.sensor);
  return report;
}

}  // namespace viewgain
