// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace viewgain {

/// How a frame was used for a map, or why it was not used.
enum class FrameVerdict : std::uint8_t {
  used,              ///< in the map; or, if not integrated yet, without a known fault
  carved,            ///< in the map, but it shows only free space
  lost_pose,         ///< its pose is not a rigid transform with finite numbers
  no_pose,           ///< it has no pose
  unreadable,        ///< a file is missing, damaged or not an image
  wrong_size,        ///< its image or mask does not have the sensor's size
  nothing_in_range,  ///< no pixel measured anything
  outside,           ///< it shows nothing of the workspace
  contradicts,       ///< even after registration it contradicts the map or other frames
  changed,           ///< its number or its image was already used by another frame
  no_mask,           ///< the file of its mask does not exist
  not_metres,        ///< nearly all depths are beyond 10 times the sensor's max_range
};

/// Names of the verdicts, in enumeration order.
inline constexpr std::array<std::string_view, 12> kFrameVerdictNames{
    "used",        "carved",     "lost_pose",        "no_pose",
    "unreadable",  "wrong_size", "nothing_in_range", "outside",
    "contradicts", "changed",    "no_mask",          "not_metres"};

/// Name of a verdict. Throws std::out_of_range for an invalid value.
[[nodiscard]] constexpr std::string_view frame_verdict_name(FrameVerdict verdict) {
  return kFrameVerdictNames.at(static_cast<std::size_t>(verdict));
}

/// Whether a frame with this verdict changed the map. Constant time; never throws.
[[nodiscard]] constexpr bool is_in_map(FrameVerdict verdict) noexcept {
  return verdict <= FrameVerdict::carved;
}

/// Number of frames per verdict. Verdicts without frames have no entry.
using FrameCounts = std::map<FrameVerdict, std::size_t>;

/// Number of frames with this verdict. Never throws.
[[nodiscard]] inline std::size_t count_of(const FrameCounts& counts, FrameVerdict verdict) {
  const auto found = counts.find(verdict);
  return found == counts.end() ? 0 : found->second;
}

/// Numbers of the frames that are not in the map, by name of their verdict.
[[nodiscard]] inline std::map<std::string, std::size_t> bad_frames(const FrameCounts& counts) {
  std::map<std::string, std::size_t> bad;
  for (const auto& [verdict, count] : counts) {
    if (!is_in_map(verdict) && count > 0) bad[std::string(frame_verdict_name(verdict))] = count;
  }
  return bad;
}

}  // namespace viewgain
