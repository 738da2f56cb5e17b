// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frames/frame_names.hpp"

#include <algorithm>
#include <cctype>
#include <cinttypes>
#include <cstdio>

#include "viewgain/core/error.hpp"

namespace viewgain {

std::string frame_name(std::uint64_t index, std::string_view suffix) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%06" PRIu64, index);
  return std::string(kFramePrefix) + number.data() + std::string(suffix);
}

std::optional<std::string> frame_number(const std::string& name, std::string_view suffix) {
  if (!name.starts_with(kFramePrefix) || !name.ends_with(suffix)) return std::nullopt;
  if (name.size() <= kFramePrefix.size() + suffix.size()) return std::nullopt;
  const std::string digits =
      name.substr(kFramePrefix.size(), name.size() - kFramePrefix.size() - suffix.size());
  if (digits.size() > 18 || !std::all_of(digits.begin(), digits.end(),
                                         [](unsigned char c) { return std::isdigit(c) != 0; })) {
    return std::nullopt;
  }
  return digits;
}

std::map<std::uint64_t, std::string> list_frames(const std::vector<std::filesystem::path>& names) {
  std::map<std::uint64_t, std::string> frames;
  for (const std::filesystem::path& name : names) {
    if (const auto digits = frame_number(name.string(), kDepthSuffix)) {
      const std::string frame = std::string(kFramePrefix) + *digits;
      const auto [other, is_new] = frames.emplace(std::stoull(*digits), frame);
      if (is_new) continue;
      throw Error(ErrorCode::format, frame + " and " + other->second + " are of one number");
    }
  }
  return frames;
}

std::filesystem::path amplitude_path(const std::filesystem::path& depth_image) {
  std::string name = depth_image.filename().string();
  name.replace(name.size() - kDepthSuffix.size(), kDepthSuffix.size(), kAmplitudeSuffix);
  return depth_image.parent_path() / name;
}

}  // namespace viewgain
