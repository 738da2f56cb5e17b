// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frames/file_stamp.hpp"
#include "frames/frame_names.hpp"
#include "frames/frames_toml.hpp"
#include "frames/pose_match.hpp"

namespace viewgain {

/// poses.txt of a folder that another program writes to, and the settings for it in frames.toml.
class GrowingPoses {
 public:
  using Time = std::chrono::steady_clock::time_point;

  GrowingPoses() = default;
  GrowingPoses(std::filesystem::path dir, std::chrono::milliseconds settle)
      : dir_(std::move(dir)), settle_(settle) {}

  /// The layout according to frames.toml. Throws like read_frames_toml(), except while the file may
  /// still be written.
  [[nodiscard]] std::optional<bool> is_recorded(Time now);

  /// Records that the folder had an image of this number, which may be removed by now.
  void add_earlier(std::uint64_t number) { first_ = std::min(first_.value_or(number), number); }

  /// Reads the lines, if they changed, and matches them to the images of these ascending numbers.
  /// Throws Error(format) if first numbers do not fit for longer than `settle`. Also throws
  /// whatever read_pose_lines() throws.
  void look(std::vector<std::uint64_t> numbers, Time now);

  /// The pose of an image; empty if it has no line yet.
  [[nodiscard]] std::optional<ReadPose> pose_of(std::uint64_t number) const;
  /// Numbers of the images that the lines need.
  [[nodiscard]] std::vector<std::uint64_t> numbers() const;
  /// Why images and lines do not fit so far; empty if they fit.
  [[nodiscard]] const std::string& misfit() const { return misfit_; }
  /// Whether the lines of the existing images are final.
  [[nodiscard]] bool is_settled(Time now) const {
    return !match_.is_by_stamps() || now - lines_since_ >= settle_;
  }

 private:
  std::filesystem::path dir_;
  std::chrono::milliseconds settle_{};
  FileStamp lines_stamp_, toml_stamp_;
  Time lines_since_{}, toml_since_{};  // when the current contents were first seen
  FramesToml said_;
  TimedPoses lines_;
  PoseMatch match_;
  bool is_last_ = false;  // no further line is expected
  std::string misfit_;
  std::optional<Time> misfit_since_;    // since when the first numbers do not fit
  std::optional<std::uint64_t> first_;  // smallest number ever seen
};

}  // namespace viewgain
