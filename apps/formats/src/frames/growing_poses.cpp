// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frames/growing_poses.hpp"

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

// The poses of complete lines; none while the file is being replaced.
TimedPoses poses_of_lines(const std::filesystem::path& path) {
  try {
    return read_pose_lines(path, {.whole_lines_alone = true});
  } catch (const Error& error) {
    if (error.code() == ErrorCode::format) throw;
    return {};
  }
}

}  // namespace

std::optional<bool> GrowingPoses::is_recorded(Time now) {
  const bool was_stable = now - toml_since_ >= settle_;
  if (const FileStamp stamp = stamp_of(dir_ / kFrames); stamp != toml_stamp_) {
    toml_stamp_ = stamp;
    toml_since_ = now;
  } else if (was_stable) {
    return said_.recorded;
  }
  try {
    said_ = read_frames_toml(dir_);
  } catch (const Error&) {
    if (now - toml_since_ >= settle_) throw;
  }
  return said_.recorded;
}

void GrowingPoses::look(std::vector<std::uint64_t> numbers, Time now) {
  if (const FileStamp stamp = stamp_of(dir_ / kPoses); stamp != lines_stamp_) {
    lines_stamp_ = stamp;
    lines_since_ = now;
    lines_ = poses_of_lines(dir_ / kPoses);
  }
  is_last_ = now - lines_since_ >= settle_;
  if (first_ && (numbers.empty() || *first_ < numbers.front())) {
    numbers.insert(numbers.begin(), *first_);
  }
  if (!numbers.empty()) first_ = numbers.front();
  match_ = match_growing_poses(dir_, lines_, numbers, said_, &misfit_);
  // Lines with later times can still arrive.
  if (misfit_.empty() || match_.is_by_stamps()) {
    misfit_since_.reset();
    return;
  }
  if (!misfit_since_) misfit_since_ = now;
  if (now - *misfit_since_ >= settle_) throw Error(ErrorCode::format, misfit_);
}

std::optional<ReadPose> GrowingPoses::pose_of(std::uint64_t number) const {
  const std::optional<std::size_t> line = match_.line_of(number);
  if (!line || (match_.may_change(number) && !is_last_)) return std::nullopt;
  return lines_.poses[*line];
}

std::vector<std::uint64_t> GrowingPoses::numbers() const {
  std::vector<std::uint64_t> numbers;
  for (std::size_t i = 0; i < lines_.poses.size(); ++i) {
    if (const auto number = match_.number_of(i)) numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace viewgain
