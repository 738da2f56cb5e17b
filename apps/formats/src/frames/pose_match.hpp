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

/// Which line of poses.txt belongs to which image: by the lines' order, by their first numbers
/// where these are the images' numbers, or by time stamps where the images' numbers are some.
class PoseMatch {
 public:
  /// The first line belongs to the image of number `first`, the next line to the next number.
  static PoseMatch in_order(std::uint64_t first, std::size_t lines);
  /// A line belongs to an image if its time [s] is the nearest one to number * unit, and at most
  /// `gap` [s] off. Unit 1 and gap 0: times are numbers.
  static PoseMatch by_time(std::span<const double> times, double unit, double gap);

  /// Index of the image's line.
  [[nodiscard]] std::optional<std::size_t> line_of(std::uint64_t number) const;
  /// Number of the line's image; nothing: the line need not have one.
  [[nodiscard]] std::optional<std::uint64_t> number_of(std::size_t line) const;
  /// Could a line that is appended later be nearer? Assumes that times rise.
  [[nodiscard]] bool may_change(std::uint64_t number) const;
  /// Why an image has no line, to go behind "poses.txt: ".
  [[nodiscard]] std::string no_pose_text(const std::string& image) const;
  [[nodiscard]] bool is_by_stamps() const { return !is_in_order_ && gap_ > 0; }

 private:
  bool is_in_order_ = true;
  std::uint64_t first_ = 0;  // in order
  std::size_t lines_ = 0;    // how many there are
  double unit_ = 1, gap_ = 0;
  std::vector<std::pair<double, std::size_t>> by_time_;  // time and line, sorted
};

/// Matches a whole folder; `numbers` are its images', rising. Throws Error(format), naming the
/// files and saying how to state it, if counts, first numbers or time stamps do not fit.
[[nodiscard]] PoseMatch match_poses(const std::filesystem::path& dir, const TimedPoses& lines,
                                    std::span<const std::uint64_t> numbers, const FramesToml& said);

/// The same for a folder that grows, line by line and image by image: counts may differ. Where
/// first numbers or time stamps do not fit so far, `*misfit` says so and nothing is matched.
[[nodiscard]] PoseMatch match_growing_poses(const std::filesystem::path& dir,
                                            const TimedPoses& lines,
                                            std::span<const std::uint64_t> numbers,
                                            const FramesToml& said, std::string* misfit);

}  // namespace viewgain
