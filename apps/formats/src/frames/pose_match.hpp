// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "frames/frame_names.hpp"
#include "frames/frames_toml.hpp"

namespace viewgain {

/// Which line of poses.txt belongs to which image: by order, by first numbers if these are the
/// images' numbers, or by time stamps if the images' numbers are time stamps.
class PoseMatch {
 public:
  /// The first line belongs to the image of number `first`, the next line to the next number.
  static PoseMatch in_order(std::uint64_t first, std::size_t lines);
  /// A line belongs to an image if its time [s] is the nearest to number * unit, within `gap` [s].
  /// With unit 1 and gap 0, times are the images' numbers.
  static PoseMatch by_time(std::span<const double> times, double unit, double gap);

  /// Index of the image's line.
  [[nodiscard]] std::optional<std::size_t> line_of(std::uint64_t number) const;
  /// Number of the line's image; empty if the line needs none.
  [[nodiscard]] std::optional<std::uint64_t> number_of(std::size_t line) const;
  /// Whether a line that is appended later could be nearer. Assumes ascending times.
  [[nodiscard]] bool may_change(std::uint64_t number) const;
  /// Why an image has no line, to follow "poses.txt: " in a message.
  [[nodiscard]] std::string no_pose_text(const std::string& image) const;
  [[nodiscard]] bool is_by_stamps() const { return !is_in_order_ && gap_ > 0; }

 private:
  bool is_in_order_ = true;
  std::uint64_t first_ = 0;  // in order
  std::size_t lines_ = 0;    // number of lines
  double unit_ = 1, gap_ = 0;
  std::vector<std::pair<double, std::size_t>> by_time_;  // time and line, sorted
};

/// Matches a complete folder; `numbers` are those of its images, ascending. If counts, first
/// numbers or time stamps do not fit, throws Error(format) naming the files and how to state the
/// match.
[[nodiscard]] PoseMatch match_poses(const std::filesystem::path& dir, const TimedPoses& lines,
                                    std::span<const std::uint64_t> numbers, const FramesToml& said);

/// The same for a growing folder, whose counts may differ. If first numbers or time stamps do not
/// fit so far, sets `*misfit` and matches nothing.
[[nodiscard]] PoseMatch match_growing_poses(const std::filesystem::path& dir,
                                            const TimedPoses& lines,
                                            std::span<const std::uint64_t> numbers,
                                            const FramesToml& said, std::string* misfit);

}  // namespace viewgain
