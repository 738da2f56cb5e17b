// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frames/pose_match.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLeastStamp = 1'000'000'000;  // larger than any number of images
constexpr double kMostGap = 0.02;                     // as in ImportConfig [s]

// Properties of the first numbers of the lines.
struct LineNumbers {
  bool are_whole = false;    // not negative, ascending
  bool are_counted = false;  // mostly consecutive, beginning below 1000
};

LineNumbers kind_of(std::span<const double> times) {
  constexpr double kMostWhole = 9e15;  // exact in double precision
  LineNumbers kind{!times.empty(), false};
  std::size_t ones = 0;
  for (std::size_t i = 0; i < times.size() && kind.are_whole; ++i) {
    kind.are_whole = times[i] >= 0 && times[i] <= kMostWhole && times[i] == std::floor(times[i]) &&
                     (i == 0 || times[i] > times[i - 1]);
    if (i > 0 && times[i] == times[i - 1] + 1) ++ones;
  }
  kind.are_counted = kind.are_whole && times.front() < 1000 && 2 * ones >= times.size() - 1;
  return kind;
}

// Unit of the lines' times: Unix time has 10 digits in s, 13 in ms, 16 in µs, 19 in ns.
double unit_of(std::span<const double> times) {
  double most = 0;
  for (const double time : times) {
    if (std::isfinite(time)) most = std::max(most, std::abs(time));
  }
  return most > 1e17 ? 1e-9 : most > 1e14 ? 1e-6 : most > 1e11 ? 1e-3 : 1;
}

// Times in s, in the clock of the images.
std::vector<double> seconds_of(const TimedPoses& lines, const FramesToml& said) {
  const double unit = unit_of(lines.times);
  std::vector<double> seconds;
  for (const double time : lines.times) seconds.push_back(time * unit + said.pose_time_offset);
  return seconds;
}

double usual_spacing(std::span<const std::uint64_t> numbers) {
  std::vector<std::uint64_t> spacings;
  for (std::size_t i = 1; i < numbers.size(); ++i) spacings.push_back(numbers[i] - numbers[i - 1]);
  if (spacings.empty()) return 0;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return static_cast<double>(*middle);
}

struct StampMatch {
  PoseMatch match;
  std::size_t matched = 0;  // images with a line
  double unit = 1e-9;       // of the images' numbers [s]
};

// Chooses the unit of the images' numbers with which most images have a line.
StampMatch match_stamps(const TimedPoses& lines, std::span<const std::uint64_t> numbers,
                        const FramesToml& said) {
  // If images are closer in time than this, their numbers count frames and are not time stamps.
  constexpr double kLeastSpacing = 0.005;
  const bool are_stamps = numbers.front() >= kLeastStamp;
  const double spacing = usual_spacing(numbers);
  const std::vector<double> seconds = seconds_of(lines, said);
  StampMatch best{PoseMatch::by_time(seconds, 1e-9, kMostGap)};
  for (const double unit : {1e-9, 1e-6, 1e-3, 1.0}) {
    if (!are_stamps && (unit == 1 || !(spacing * unit >= kLeastSpacing))) continue;
    const double gap = spacing > 0 ? std::min(kMostGap, spacing * unit / 2) : kMostGap;
    StampMatch one{PoseMatch::by_time(seconds, unit, gap), 0, unit};
    one.matched = static_cast<std::size_t>(
        std::count_if(numbers.begin(), numbers.end(),
                      [&](std::uint64_t number) { return one.match.line_of(number).has_value(); }));
    if (one.matched > best.matched) best = std::move(one);
  }
  return best;
}

// Unix times without an exponent.
std::string fixed_text(double value) {
  std::array<char, 400> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, 3);
  return {digits.data(), end.ptr};
}

std::string in(const fs::path& dir) { return (dir / kFrames).string(); }

std::string stamps_misfit(const fs::path& dir, const TimedPoses& lines,
                          std::span<const std::uint64_t> numbers, const FramesToml& said) {
  std::vector<double> seconds = seconds_of(lines, said);
  std::erase_if(seconds, [](double time) { return !std::isfinite(time); });
  if (seconds.empty()) {
    return (dir / kPoses).string() +
           ": the lines contain no times, but the images have time stamps";
  }
  const auto [first, last] = std::minmax_element(seconds.begin(), seconds.end());
  const auto back = static_cast<double>(numbers.back());
  const double unit = unit_of(std::array{back});
  const double start = static_cast<double>(numbers.front()) * unit;
  return (dir / kPoses).string() + ": the times of the poses (" + fixed_text(*first) + " to " +
         fixed_text(*last) + " s) and the time stamps of the images (" + fixed_text(start) +
         " to " + fixed_text(back * unit) +
         " s) do not overlap. If the clocks differ, add pose_time_offset = " +
         fixed_text(said.pose_time_offset + start - *first) + " to " + in(dir) +
         ". This value [s] is right if the first pose belongs to the first image";
}

std::string range_text(std::uint64_t first, std::uint64_t last) {
  return first == last ? std::to_string(first)
                       : std::to_string(first) + " to " + std::to_string(last);
}

std::string numbers_misfit(const fs::path& dir, const TimedPoses& lines,
                           std::span<const std::uint64_t> numbers, LineNumbers kind) {
  std::string poses = std::to_string(lines.poses.size());
  if (kind.are_whole) {
    poses += ", numbered " + range_text(static_cast<std::uint64_t>(lines.times.front()),
                                        static_cast<std::uint64_t>(lines.times.back()));
  }
  const std::string first_image = std::to_string(numbers.front());
  std::string cure =
      "Begin each line with the number of its image. If the first line belongs to the first image, "
      "you can instead add first_frame = " +
      first_image;
  if (kind.are_whole) {
    cure =
        "If each line begins with the number of its image, but images or lines are missing, add "
        "first_frame = " +
        std::to_string(static_cast<std::uint64_t>(lines.times.front())) +
        ". If the first line belongs to the first image, add first_frame = " + first_image;
  }
  return (dir / kPoses).string() + ": the poses do not match the images. Poses: " + poses +
         "; images: " + std::to_string(numbers.size()) + ", numbered " +
         range_text(numbers.front(), numbers.back()) +
         ". It is not known which pose belongs to which image. " + cure + " to " + in(dir);
}

bool has_all(const PoseMatch& match, std::span<const std::uint64_t> numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [&](std::uint64_t number) { return match.line_of(number).has_value(); });
}

}  // namespace

PoseMatch PoseMatch::in_order(std::uint64_t first, std::size_t lines) {
  PoseMatch match;
  match.first_ = first;
  match.lines_ = lines;
  return match;
}

PoseMatch PoseMatch::by_time(std::span<const double> times, double unit, double gap) {
  PoseMatch match;
  match.is_in_order_ = false;
  match.lines_ = times.size();
  match.unit_ = unit, match.gap_ = gap;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (std::isfinite(times[i])) match.by_time_.emplace_back(times[i], i);
  }
  std::sort(match.by_time_.begin(), match.by_time_.end());
  return match;
}

std::optional<std::size_t> PoseMatch::line_of(std::uint64_t number) const {
  if (is_in_order_) {
    if (number < first_ || number - first_ >= lines_) return std::nullopt;
    return static_cast<std::size_t>(number - first_);
  }
  const double time = static_cast<double>(number) * unit_;
  const auto at = [&](double t) {
    return std::lower_bound(by_time_.begin(), by_time_.end(), std::pair(t, std::size_t{0}));
  };
  auto best = at(time);
  if (best != by_time_.begin()) {
    const auto before = at(std::prev(best)->first);  // the first of equal ones
    if (best == by_time_.end() || time - before->first <= best->first - time) best = before;
  }
  if (best == by_time_.end() || std::abs(best->first - time) > gap_) return std::nullopt;
  return best->second;
}

std::optional<std::uint64_t> PoseMatch::number_of(std::size_t line) const {
  if (is_in_order_) return first_ + line;
  if (gap_ > 0) return std::nullopt;
  return static_cast<std::uint64_t>(by_time_.at(line).first);  // numbers ascend with the lines
}

bool PoseMatch::may_change(std::uint64_t number) const {
  return is_by_stamps() &&
         (by_time_.empty() || by_time_.back().first < static_cast<double>(number) * unit_);
}

std::string PoseMatch::no_pose_text(const std::string& image) const {
  if (is_by_stamps()) return "the file has no pose within " + short_text(gap_) + " s of " + image;
  return "the file has " + std::to_string(lines_) + " poses, but none for " + image;
}

PoseMatch match_poses(const fs::path& dir, const TimedPoses& lines,
                      std::span<const std::uint64_t> numbers, const FramesToml& said) {
  const std::size_t count = lines.poses.size();
  if (said.first_frame) return PoseMatch::in_order(*said.first_frame, count);
  if (numbers.empty() || count == 0) return PoseMatch::in_order(0, count);
  const auto refuse = [](const std::string& what) { throw Error(ErrorCode::format, what); };
  if (numbers.front() >= kLeastStamp) {
    StampMatch stamps = match_stamps(lines, numbers, said);
    if (stamps.matched == 0) refuse(stamps_misfit(dir, lines, numbers, said));
    return std::move(stamps.match);
  }
  const LineNumbers kind = kind_of(lines.times);
  if (kind.are_whole) {
    PoseMatch match = PoseMatch::by_time(lines.times, 1, 0);
    // Both ends agree, so images or lines in between are really missing.
    if (has_all(match, std::array{numbers.front(), numbers.back()}) && has_all(match, numbers) &&
        match.line_of(numbers.front()) == 0 && match.line_of(numbers.back()) == count - 1) {
      return match;
    }
  }
  const bool is_counted_otherwise = kind.are_counted && count > 1;
  if (numbers.front() == 0 && numbers.back() == count - 1 && !is_counted_otherwise) {
    return PoseMatch::in_order(0, count);
  }
  StampMatch stamps = match_stamps(lines, numbers, said);
  if (2 * stamps.matched <= numbers.size()) refuse(numbers_misfit(dir, lines, numbers, kind));
  return std::move(stamps.match);
}

PoseMatch match_growing_poses(const fs::path& dir, const TimedPoses& lines,
                              std::span<const std::uint64_t> numbers, const FramesToml& said,
                              std::string* misfit) {
  const std::size_t count = lines.poses.size();
  misfit->clear();
  if (said.first_frame) return PoseMatch::in_order(*said.first_frame, count);
  if (numbers.empty() || count == 0) return PoseMatch::in_order(0, count);
  StampMatch stamps = match_stamps(lines, numbers, said);
  if (numbers.front() >= kLeastStamp) {
    if (stamps.matched == 0) *misfit = stamps_misfit(dir, lines, numbers, said);
    return std::move(stamps.match);
  }
  const LineNumbers kind = kind_of(lines.times);
  std::uint64_t first = 0;  // first image according to the lines
  PoseMatch match = PoseMatch::in_order(0, count);
  if (kind.are_whole) {
    PoseMatch numbered = PoseMatch::by_time(lines.times, 1, 0);
    const auto known = std::upper_bound(numbers.begin(), numbers.end(),
                                        static_cast<std::uint64_t>(lines.times.back()));
    const std::span reached = numbers.first(static_cast<std::size_t>(known - numbers.begin()));
    const bool is_numbered = !reached.empty() && has_all(numbered, reached);
    if (is_numbered || (kind.are_counted && count > 1)) {
      match = std::move(numbered);
      first = static_cast<std::uint64_t>(lines.times.front());
    }
  }
  if (2 * stamps.matched > numbers.size()) return std::move(stamps.match);
  if (numbers.front() != first) {
    *misfit = numbers_misfit(dir, lines, numbers, kind);
    return PoseMatch::in_order(0, 0);
  }
  return match;
}

}  // namespace viewgain
