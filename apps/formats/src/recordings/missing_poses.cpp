// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "recordings/missing_poses.hpp"

#include <algorithm>
#include <cmath>

namespace viewgain {

std::string seconds_text(std::int64_t stamp) {
  std::string fraction = std::to_string(std::abs(stamp / 1'000'000 % 1000));
  fraction.insert(0, 3 - fraction.size(), '0');
  return std::to_string(stamp / kNanoseconds) + '.' + fraction;
}

void MissingPoses::add(TransformTree::Found why, std::int64_t stamp) {
  ++counts_.at(static_cast<std::size_t>(why) - 1);
  from_ = std::min(from_, stamp), to_ = std::max(to_, stamp);
}

std::string MissingPoses::text(const TransformTree::Chain& chain, bool are_all) const {
  constexpr std::array kWhere{"before the first transform", "after the last transform",
                              "in gaps between transforms (--max-time-gap)",
                              "in unconnected frames"};
  std::string text = "images without a pose:";
  for (std::size_t i = 0; i < kWhere.size(); ++i) {
    if (counts_[i] > 0) text += " " + std::to_string(counts_[i]) + " " + kWhere[i] + ",";
  }
  text.pop_back();
  if (counts_[2] > 0) text += "; the largest gap is " + TransformTree::largest_gap(chain);
  const std::array<std::int64_t, 2> span = TransformTree::span_of(chain);
  if (span[0] == INT64_MIN) return text;  // all transforms are static
  text += "; transforms are from " + seconds_text(span[0]) + " to " + seconds_text(span[1]) +
          " s, these images from " + seconds_text(from_) + " to " + seconds_text(to_) + " s";
  const bool is_apart = are_all && counts_[2] + counts_[3] == 0 &&
                        (from_ - 10 * kNanoseconds > span[1] || to_ + 10 * kNanoseconds < span[0]);
  if (is_apart) text += ". The clocks of the camera and the robot differ";
  return text;
}

}  // namespace viewgain
