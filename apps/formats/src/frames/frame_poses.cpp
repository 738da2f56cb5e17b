// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frames/frame_poses.hpp"

#include <limits>
#include <string>
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

std::vector<ReadPose> read_pose_lines(const fs::path& path, bool whole_lines_alone,
                                      std::vector<double>* times) {
  std::string text = file_bytes(path);
  if (whole_lines_alone) text.resize(text.rfind('\n') + 1);  // none: 0
  std::vector<ReadPose> poses;
  for (LineReader line(path.string(), text); line.next();) {
    if (line.words().empty() || line.words().front().front() == '#') continue;
    if (times != nullptr) {
      times->push_back(std::numeric_limits<double>::quiet_NaN());
      try {
        times->back() = line.finite_number(0);
      } catch (const Error&) {  // the pose has no time then
      }
    }
    if (times == nullptr && poses.empty()) {
      // As a lost pose it would give every image the pose of the one before.
      try {
        (void)line.number(0);
      } catch (const Error&) {
        line.fail("is no pose; a heading begins with '#'");
      }
    }
    try {
      ReadPose read;
      read.T_world_camera = tum_line_pose(line, &read.is_mended);
      poses.push_back(std::move(read));
    } catch (const Error& error) {
      poses.push_back(unknown_pose(FrameVerdict::lost_pose, error.what()));
    }
  }
  return poses;
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

}  // namespace viewgain
