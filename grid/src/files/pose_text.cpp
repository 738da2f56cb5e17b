// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "pose_text.hpp"

#include <charconv>
#include <cmath>

#include "viewgain/support/text.hpp"

namespace viewgain::detail {

std::string poses_to_text(const std::vector<Pose>& poses) {
  std::string text;
  for (const Pose& pose : poses) {
    for (std::size_t i = 0; i < pose.m.size(); ++i) {
      text += short_text(pose.m[i]);
      text.push_back(i + 1 < pose.m.size() ? ' ' : '\n');
    }
  }
  return text;
}

std::optional<std::vector<Pose>> poses_from_text(std::string_view text) {
  std::vector<Pose> poses;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    Pose pose;
    for (std::size_t i = 0; i < pose.m.size(); ++i) {
      const auto result = std::from_chars(at, end, pose.m[i]);
      if (result.ec != std::errc{} || !std::isfinite(pose.m[i]) || result.ptr == end) {
        return std::nullopt;
      }
      at = result.ptr;
      if (*at++ != (i + 1 < pose.m.size() ? ' ' : '\n')) return std::nullopt;
    }
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace viewgain::detail
