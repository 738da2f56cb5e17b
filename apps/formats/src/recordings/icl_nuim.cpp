// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <map>
#include <string>

#include "folders.hpp"
#include "recordings/parts.hpp"
#include "viewgain/core/error.hpp"

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

}  // namespace viewgain
