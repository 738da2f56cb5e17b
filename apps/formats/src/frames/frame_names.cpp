// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frames/frame_names.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <limits>
#include <utility>

#include "folders.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

namespace fs = std::filesystem;

ReadPose unknown_pose(FrameVerdict verdict, std::string what) {
  ReadPose pose{{}, false, {verdict, std::move(what)}};
  pose.T_world_camera.m.fill(std::numeric_limits<double>::infinity());
  return pose;
}

TimedPoses read_pose_lines(const fs::path& path, PoseLineRules rules) {
  std::string text = folder_file_bytes(path);
  if (rules.whole_lines_alone) text.resize(text.rfind('\n') + 1);  // none: 0
  TimedPoses read;
  for (LineReader line(path.string(), text); line.next();) {
    if (line.words().empty() || line.words().front().front() == '#') continue;
    if (!rules.allows_heading && read.poses.empty()) {
      // A heading read as a lost pose would give every image the pose of the previous image.
      try {
        (void)line.number(0);
      } catch (const Error&) {
        line.fail("the line is not a pose; a heading must begin with '#'");
      }
    }
    read.times.push_back(std::numeric_limits<double>::quiet_NaN());
    try {
      read.times.back() = line.finite_number(0);
    } catch (const Error&) {  // the pose then has no time
    }
    try {
      ReadPose pose;
      pose.T_world_camera = tum_line_pose(line, &pose.is_mended);
      read.poses.push_back(std::move(pose));
    } catch (const Error& error) {
      read.poses.push_back(unknown_pose(FrameVerdict::lost_pose, error.what()));
    }
  }
  return read;
}

ReadPose read_pose_file(const fs::path& path) {
  ReadPose read;
  try {
    if (!is_there(path)) {
      return unknown_pose(FrameVerdict::no_pose, path.string() + ": no such file");
    }
    read.T_world_camera = read_pose_matrix(path, &read.is_mended);
  } catch (const Error& error) {
    return unknown_pose(FrameVerdict::lost_pose, error.what());
  }
  return read;
}

std::string frame_name(std::uint64_t index, std::string_view suffix) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%06" PRIu64, index);
  return std::string(kFramePrefix) + number.data() + std::string(suffix);
}

std::optional<std::string> frame_number(const std::string& name, std::string_view suffix) {
  if (!name.starts_with(kFramePrefix) || !name.ends_with(suffix)) return std::nullopt;
  if (name.size() <= kFramePrefix.size() + suffix.size()) return std::nullopt;
  const std::string digits =
      name.substr(kFramePrefix.size(), name.size() - kFramePrefix.size() - suffix.size());
  const bool are_digits = std::all_of(digits.begin(), digits.end(),
                                      [](unsigned char c) { return std::isdigit(c) != 0; });
  return are_digits ? std::optional(digits) : std::nullopt;
}

std::optional<std::uint64_t> frame_index(const std::string& digits) {
  std::uint64_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const bool is_whole = error == std::errc{} && end == digits.data() + digits.size();
  return is_whole ? std::optional(index) : std::nullopt;
}

std::map<std::uint64_t, std::string> list_frames(const std::vector<std::string>& names,
                                                 FramesLeftOut* left_out) {
  std::map<std::uint64_t, std::string> frames;
  for (const std::string& name : names) {
    if (const auto digits = frame_number(name, kDepthSuffix)) {
      const std::string frame = std::string(kFramePrefix) + *digits;
      const std::optional<std::uint64_t> number = frame_index(*digits);
      if (number && frames.emplace(*number, frame).second) continue;
      if (left_out == nullptr) {
        throw Error(ErrorCode::format, number ? frame + " and " + frames.at(*number) +
                                                    " have the same number; rename one of them"
                                              : frame + " has a number of more than 64 bits");
      }
      left_out->emplace(frame, number);
    }
  }
  return frames;
}

std::filesystem::path amplitude_path(const std::filesystem::path& depth_image) {
  std::string name = depth_image.filename().string();
  name.replace(name.size() - kDepthSuffix.size(), kDepthSuffix.size(), kAmplitudeSuffix);
  return depth_image.parent_path() / name;
}

}  // namespace viewgain
