// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "viewgain/grid/voxel.hpp"

namespace viewgain::detail {

// A voxel in one byte: 0 is unknown, otherwise its log-odds in steps of 0.05, plus kZeroCode.
inline constexpr std::uint8_t kUnknownCode = 0;
inline constexpr std::uint8_t kMinCode = 1;    ///< log-odds -2
inline constexpr std::uint8_t kZeroCode = 41;  ///< log-odds 0; occupied above
inline constexpr std::uint8_t kMaxCode = 111;  ///< log-odds 3.5
inline constexpr double kLogOddsStep = 0.05;

// Effect of one frame on a voxel, in steps.
inline constexpr std::int8_t kNoDelta = -128;  ///< none
inline constexpr std::int8_t kMissDelta = -8;  ///< crossed, far from the reading: -0.4
inline constexpr std::int8_t kHitDelta = 17;   ///< contains a reading: +0.85

inline constexpr int kBlockVoxels = 512;
inline constexpr std::uint8_t kLiteralFreeCode = kZeroCode + kMissDelta;
inline constexpr std::uint8_t kLiteralOccupiedCode = kZeroCode + kHitDelta;

[[nodiscard]] inline bool is_occupied(std::uint8_t code) { return code > kZeroCode; }
[[nodiscard]] inline bool is_non_free(std::uint8_t code) {
  return code == kUnknownCode || code > kZeroCode;
}
[[nodiscard]] inline VoxelState code_state(std::uint8_t code) {
  return code == kUnknownCode ? VoxelState::unknown
         : is_occupied(code)  ? VoxelState::occupied
                              : VoxelState::free;
}
/// Whether uniform blocks with this code are stored as tiles; an occupied voxel lies in a leaf, or
/// in the single cell of a block of the largest scale.
[[nodiscard]] inline bool may_be_tile(std::uint8_t code) { return code <= kZeroCode; }

[[nodiscard]] inline float code_log_odds(std::uint8_t code) {
  return static_cast<float>(kLogOddsStep * (static_cast<int>(code) - static_cast<int>(kZeroCode)));
}
/// Nearest step, clamped; log_odds must not be NaN.
[[nodiscard]] inline std::uint8_t log_odds_code(double log_odds) {
  const double steps = std::clamp(std::round(log_odds / kLogOddsStep), -40.0, 70.0);
  return static_cast<std::uint8_t>(static_cast<int>(steps) + static_cast<int>(kZeroCode));
}

/// The code after one frame with this `delta`.
[[nodiscard]] inline std::uint8_t updated_code(std::uint8_t code, std::int8_t delta, bool literal) {
  if (delta == kNoDelta) return code;
  if (literal) return delta > 0 ? kLiteralOccupiedCode : kLiteralFreeCode;
  const int before = code == kUnknownCode ? kZeroCode : code;
  return static_cast<std::uint8_t>(
      std::clamp(before + delta, static_cast<int>(kMinCode), static_cast<int>(kMaxCode)));
}

/// Steps that a crossing subtracts, 0..8: full strength from `taper` in front of the reading. gap >
/// 0 is the distance to the reading; taper is 3 sigma_ax, or 0 without a reading.
[[nodiscard]] inline int miss_weight(double gap, double taper) {
  if (gap >= taper) return -kMissDelta;
  return static_cast<int>(std::floor(-kMissDelta * (gap / taper) + 0.5));
}

}  // namespace viewgain::detail
