// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/parts.hpp"

#include <algorithm>

#include "folders.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {

namespace fs = std::filesystem;

TimedPoses read_timed_poses(const fs::path& path) {
  TimedPoses read;
  read.poses = read_pose_lines(path, false, &read.times);
  const bool has_any = std::any_of(read.poses.begin(), read.poses.end(), [](const ReadPose& pose) {
    return pose.fault.verdict == FrameVerdict::used;
  });
  if (!has_any) {
    throw Error(ErrorCode::format, read.poses.empty() ? path.string() + ": holds no pose"
                                                      : read.poses.front().fault.what);
  }
  return read;
}

void drop_frame(Recording& recording, const FrameFault& why) {
  ++recording.dropped[why.verdict];
  if (recording.fault.empty()) recording.fault = why.what;
}

void add_frame(Recording& recording, std::uint64_t number, const fs::path& image,
               const ReadPose& pose) {
  if (pose.fault.verdict != FrameVerdict::used) return drop_frame(recording, pose.fault);
  recording.frames.push_back({number, image, pose.T_world_camera});
  recording.orthonormalized += pose.is_mended ? 1 : 0;
}

std::map<std::uint64_t, fs::path> numbered_images(const fs::path& folder) {
  constexpr std::size_t kMostDigits = 18;
  std::map<std::uint64_t, fs::path> images;
  for (const fs::path& name : names_in(folder)) {
    const std::string digits = name.stem().string();
    if (name.extension() != ".png" || digits.empty() || digits.size() > kMostDigits ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
      continue;
    }
    const auto [other, is_new] = images.emplace(std::stoull(digits), folder / name);
    if (!is_new) {
      throw Error(ErrorCode::format,
                  (folder / name).string() + ": has the same number as " + other->second.string());
    }
  }
  if (images.empty()) {
    throw Error(ErrorCode::io, folder.string() + ": no folder with images called NUMBER.png");
  }
  return images;
}

void refuse_camera(const RecordingConfig& config, const fs::path& source) {
  if (!config.camera) return;
  throw Error(ErrorCode::invalid_argument,
              source.string() + ": a recording of this format has intrinsics of its own");
}

}  // namespace viewgain
