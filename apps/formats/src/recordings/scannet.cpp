// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "recordings/parts.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

PinholeCamera read_camera(const fs::path& path) {
  const std::vector<double> m = finite_numbers(path);
  if (m.size() != 16) {
    throw Error(ErrorCode::format, path.string() + ": expected 16 numbers (a 4x4 matrix), found " +
                                       std::to_string(m.size()));
  }
  return camera_of_matrix({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}, path.string());
}

}  // namespace

Recording open_scannet(const fs::path& source, const RecordingConfig& config) {
  refuse_camera(config, source);
  Recording recording;
  recording.camera = read_camera(source / "intrinsic" / "intrinsic_depth.txt");
  recording.depth_scale = kMillimetre;
  for (const auto& [number, image] : numbered_images(source / "depth")) {
    const fs::path pose = source / "pose" / (image.stem().string() + ".txt");
    add_frame(recording, number, image, read_pose_file(pose));
  }
  return recording;
}

}  // namespace viewgain
