// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/recordings.hpp"
#include "viewgain/formats/staged_folder.hpp"

namespace viewgain {

/// A folder in the recorded layout that appears, or changes, only when everything is written.
class RecordedFolder {
 public:
  /// Throws Error(invalid_argument) for a folder with frames that were not imported.
  explicit RecordedFolder(const std::filesystem::path& dir);

  void write(std::uint64_t number, const GrayImage& depth, const Pose& T_world_camera);

  /// `depth_scale` [m per unit]; `out_of_range`: the meaning of 65535.
  void commit(const PinholeCamera& camera, const std::optional<Sensor>& sensor, double depth_scale,
              Sensor::OutOfRange out_of_range);

 private:
  void put(const std::string& name, const std::string& text);

  std::vector<std::filesystem::path> earlier_;
  StagedFolder staged_;
  std::set<std::string> files_;  // written files
};

/// Counts frames that cannot be used, and keeps the first fault of a file's contents.
struct Dropped {
  FrameCounts& counts;
  std::string fault{};

  void add(const FrameFault& why) {
    ++counts[why.verdict];
    if (fault.empty()) fault = why.what;
  }
  /// Throws Error(format) that names the recording and the reasons.
  [[noreturn]] void fail_without_frames(const std::filesystem::path& source) const;
};

/// "640x480"
[[nodiscard]] std::string size_text(std::int64_t width, std::int64_t height);

}  // namespace viewgain
