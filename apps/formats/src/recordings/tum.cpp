// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "folders.hpp"
#include "recordings/parts.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

// What is published with the images.
PinholeCamera published_camera() {
  PinholeCamera camera;
  camera.fx = 481.2, camera.fy = -480.0;
  camera.cx = 319.5, camera.cy = 239.5;
  return camera;
}

// The one *.gt.freiburg, which has the sequence's name, or what others have renamed it to.
fs::path poses_file(const fs::path& source) {
  fs::path found;
  for (const fs::path& name : names_in(source)) {
    if (!name.string().ends_with(".gt.freiburg")) continue;
    if (!found.empty()) {
      throw Error(ErrorCode::format, (source / name).string() + ": a second file of poses beside " +
                                         found.filename().string());
    }
    found = source / name;
  }
  return found.empty() ? source / "groundtruth.txt" : found;
}

}  // namespace

Recording open_icl_nuim(const fs::path& source, const RecordingConfig& config) {
  const TimedPoses poses = read_timed_poses(poses_file(source));
  std::map<double, std::size_t> of_number;
  for (std::size_t i = 0; i < poses.times.size(); ++i) {
    if (std::isfinite(poses.times[i])) of_number.emplace(poses.times[i], i);
  }
  Recording recording;
  recording.camera = config.camera.value_or(published_camera());
  recording.depth_scale = kTumDepthUnit;
  for (const auto& [number, image] : numbered_images(source / "depth")) {
    const auto pose = of_number.find(static_cast<double>(number));
    if (pose == of_number.end()) {
      drop_frame(recording, {FrameVerdict::no_pose});
      continue;
    }
    add_frame(recording, number, image, poses.poses[pose->second]);
  }
  return recording;
}

namespace {

// Poses in the order of their times, whatever order the file has.
class PosesInTime {
 public:
  explicit PosesInTime(const TimedPoses& poses) : times_(poses.times) {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (std::isfinite(times_[i])) order_.push_back(i);
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [this](std::size_t a, std::size_t b) { return times_[a] < times_[b]; });
  }

  // The pose nearest in time, the earlier of two; nothing if it is farther than the gap.
  [[nodiscard]] std::optional<std::size_t> nearest(double time, double gap) const {
    const auto after =
        std::lower_bound(order_.begin(), order_.end(), time,
                         [this](std::size_t pose, double wanted) { return times_[pose] < wanted; });
    std::optional<std::size_t> best;
    const auto offer = [&](std::size_t pose) {
      const double off = std::abs(times_[pose] - time);
      if (off <= gap && (!best || off < std::abs(times_[*best] - time))) best = pose;
    };
    if (after != order_.begin()) offer(*(after - 1));
    if (after != order_.end()) offer(*after);
    return best;
  }

 private:
  const std::vector<double>& times_;
  std::vector<std::size_t> order_;
};

}  // namespace

Recording open_tum(const std::filesystem::path& source, const RecordingConfig& config) {
  if (!config.camera) {
    throw Error(ErrorCode::invalid_argument,
                source.string() + ": a TUM recording does not say its intrinsics");
  }
  const std::filesystem::path list = source / "depth.txt";
  const std::string bytes = file_bytes(list);
  const TimedPoses poses = read_timed_poses(source / "groundtruth.txt");
  const PosesInTime in_time(poses);
  Recording recording;
  recording.camera = *config.camera;
  recording.depth_scale = kTumDepthUnit;
  std::uint64_t number = 0;
  for (LineReader line(list.string(), bytes); line.next();) {
    if (line.words().empty() || line.words().front().front() == '#') continue;
    if (line.words().size() != 2) {
      line.fail("expected a timestamp and an image, found " + std::to_string(line.words().size()) +
                " words");
    }
    // A recording may be of anybody, and names no files of elsewhere.
    const auto image = std::filesystem::path(line.words()[1]).lexically_normal();
    if (image.is_absolute() || *image.begin() == "..") {
      line.fail("the image " + quoted(line.words()[1]) + " is outside of the recording");
    }
    const auto pose = in_time.nearest(line.finite_number(0), config.max_time_gap);
    if (pose) {
      add_frame(recording, number, source / image, poses.poses[*pose]);
    } else {
      drop_frame(recording, {FrameVerdict::no_pose});
    }
    ++number;
  }
  if (number == 0) throw Error(ErrorCode::format, list.string() + ": names no image");
  return recording;
}

}  // namespace viewgain
