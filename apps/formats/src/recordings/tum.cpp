// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The layout of TUM's RGB-D data sets.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "recordings/importers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr double kTumUnit = 1.0 / 5000;  // of the images [m]
constexpr double kTumGap = 0.02;         // [s]

TimedPoses read_timed_poses(const fs::path& path) {
  TimedPoses read = read_pose_lines(path, {.allows_heading = true});
  const bool has_any = std::any_of(read.poses.begin(), read.poses.end(), [](const ReadPose& pose) {
    return pose.fault.verdict == FrameVerdict::used;
  });
  if (!has_any) {
    throw Error(ErrorCode::format, read.poses.empty()
                                       ? path.string() + ": the file contains no pose"
                                       : read.poses.front().fault.what);
  }
  return read;
}

// The pose nearest in time, the first of equal ones; null if it is farther than the gap.
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

std::vector<RecordedFrame> read_tum_frames(const fs::path& source, double max_time_gap,
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
      line.fail("expected a timestamp and an image; found " + std::to_string(line.words().size()) +
                " words");
    }
    // A recording is untrusted, and must not name files outside.
    const fs::path image = path_inside(std::string(line.words()[1]));
    if (image.empty()) {
      line.fail("the image " + quoted(line.words()[1]) + " is outside the recording");
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
      dropped.add({FrameVerdict::changed, where + ": an earlier line uses the same image"});
    } else {
      refuse_link_out(source, source / image);
      frames.push_back({number, source / image, *pose});
    }
    ++number;
  }
  if (number == 0) throw Error(ErrorCode::format, list.string() + ": the file lists no image");
  return frames;
}

}  // namespace

ImportReport import_tum(const fs::path& source, const fs::path& out, const ImportConfig& config) {
  ImportReport report;
  if (!(config.camera.fx > 0) && !config.sensor) {
    refuse(source.string() +
           ": a recording in the TUM layout does not state its camera; give the camera");
  }
  report.camera = config.camera.fx > 0 ? config.camera : config.sensor->camera;
  Dropped dropped{report.bad};
  const std::vector<RecordedFrame> frames =
      read_tum_frames(source, config.max_time_gap.value_or(kTumGap), dropped);
  import_images(source, frames, config.depth_scale.value_or(kTumUnit), config, out, dropped,
                report);
  return report;
}

}  // namespace viewgain
