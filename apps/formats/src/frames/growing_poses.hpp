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

/// poses.txt of a folder into which somebody else writes, and what frames.toml says of it.
class GrowingPoses {
 public:
  using Time = std::chrono::steady_clock::time_point;

  GrowingPoses() = default;
  GrowingPoses(std::filesystem::path dir, std::chrono::milliseconds settle)
      : dir_(std::move(dir)), settle_(settle) {}

  /// What frames.toml says of the layout. Throws as read_frames_toml(), unless somebody may be
  /// writing the file.
  [[nodiscard]] std::optional<bool> is_recorded(Time now);

  /// The folder had an image of this number, which may be gone.
  void add_earlier(std::uint64_t number) { first_ = std::min(first_.value_or(number), number); }

  /// Reads the lines, if there are others, and matches them to the images of these numbers, which
  /// rise. Throws Error(format) if first numbers do not fit for `settle`, and as read_pose_lines().
  void look(std::vector<std::uint64_t> numbers, Time now);

  /// Nothing: no line is the image's yet.
  [[nodiscard]] std::optional<ReadPose> pose_of(std::uint64_t number) const;
  /// Numbers of the images that the lines need.
  [[nodiscard]] std::vector<std::uint64_t> numbers() const;
  /// Why images and lines do not fit so far; empty: they do.
  [[nodiscard]] const std::string& misfit() const { return misfit_; }
  /// Will the images that are there get no other lines than they have?
  [[nodiscard]] bool is_settled(Time now) const {
    return !match_.is_by_stamps() || now - lines_since_ >= settle_;
  }

 private:
  std::filesystem::path dir_;
  std::chrono::milliseconds settle_{};
  FileStamp lines_stamp_, toml_stamp_;
  Time lines_since_{}, toml_since_{};  // when they were first seen as they are
  FramesToml said_;
  TimedPoses lines_;
  PoseMatch match_;
  bool is_last_ = false;  // no line is expected to come
  std::string misfit_;
  std::optional<Time> misfit_since_;    // of first numbers
  std::optional<std::uint64_t> first_;  // number that was ever seen
};

}  // namespace viewgain
