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

/// What became of a frame on its way into a map.
enum class FrameVerdict : std::uint8_t {
  used,    ///< the map has readings of it; of one that is only read so far: nothing is against it
  carved,  ///< in the map; it has shown free space alone
  lost_pose,         ///< its pose is no rigid transform of finite numbers
  no_pose,           ///< it has none
  unreadable,        ///< a file is missing, cut off, damaged or of another kind
  wrong_size,        ///< its image or mask has another size than the sensor's
  nothing_in_range,  ///< no pixel says anything
  outside,           ///< it shows nothing of the workspace
  contradicts,       ///< registered, it contradicts the map or the other frames
  changed,           ///< its number, or its image in a recording's list, was taken before
  no_mask,           ///< the mask that it needs never came
  not_metres,        ///< nearly all depths are beyond 10 times the sensor's max_range
};

/// Names of the verdicts, in their order.
inline constexpr std::array<std::string_view, 12> kFrameVerdictNames{
    "used",        "carved",     "lost_pose",        "no_pose",
    "unreadable",  "wrong_size", "nothing_in_range", "outside",
    "contradicts", "changed",    "no_mask",          "not_metres"};

/// Its name. Throws std::out_of_range for a number that is none of them.
[[nodiscard]] constexpr std::string_view frame_verdict_name(FrameVerdict verdict) {
  return kFrameVerdictNames.at(static_cast<std::size_t>(verdict));
}

/// Has the map changed by the frame? Constant time; never throws.
[[nodiscard]] constexpr bool is_in_map(FrameVerdict verdict) noexcept {
  return verdict <= FrameVerdict::carved;
}

/// How many frames had each verdict; what is not there had none.
using FrameCounts = std::map<FrameVerdict, std::size_t>;

/// Those of one verdict. Never throws.
[[nodiscard]] inline std::size_t count_of(const FrameCounts& counts, FrameVerdict verdict) {
  const auto found = counts.find(verdict);
  return found == counts.end() ? 0 : found->second;
}

/// Those that are not in the map, by the verdict's name.
[[nodiscard]] inline std::map<std::string, std::size_t> bad_frames(const FrameCounts& counts) {
  std::map<std::string, std::size_t> bad;
  for (const auto& [verdict, count] : counts) {
    if (!is_in_map(verdict) && count > 0) bad[std::string(frame_verdict_name(verdict))] = count;
  }
  return bad;
}

}  // namespace viewgain
