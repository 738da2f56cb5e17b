// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "check/frame_meetings.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/frame_check.hpp"
#include "viewgain/raycast/suspect_frames.hpp"

namespace viewgain::detail {

/// A frame contradicts the others from this share on.
inline constexpr double kContradicting = 0.05;

/// Frames contradict each other above these shares of all readings. Correct simulated frames reach
/// 0.9 % and 0.2 %, a recorded room 1.6 % and 3.6 %.
inline constexpr double kInFree = 0.025, kSeenPast = 0.05;
/// With fewer contradicting readings, nothing is suspected.
inline constexpr std::size_t kEnoughContradictions = 20;
/// Limit for a single frame that has enough readings.
inline constexpr double kOfAFrame = 0.2;
inline constexpr std::size_t kEnoughReadings = 50;

/// Frames are displaced if the median displacement is above this multiple of the declared errors
/// and this part of a voxel. A recorded room has 1.0 times, parts of it up to 1.4.
inline constexpr double kDisplaced = 2, kOfAVoxel = 0.15;
inline constexpr std::size_t kEnoughFrames = 5;

/// Over frames with enough readings, the largest fraction of a frame's readings in other frames'
/// free space, or of others' readings in its own.
[[nodiscard]] double largest_share(const FrameConsistency& found);

/// Whether a displacement is clearly larger than the declared errors explain, and than a small part
/// of a voxel. All in [m].
[[nodiscard]] bool is_displaced(double displacement, double expected, double voxel_size);

/// Whether and how the frames of a map with this voxel size [m] contradict each other: kinds
/// same_image, contradiction and displacement.
[[nodiscard]] Suspicion suspect_contradiction(const FrameConsistency& found, double voxel_size);

/// What is probably wrong with the frames of `meeting`; `contradiction` if no better reason is
/// found.
[[nodiscard]] Suspicion suspicion_of(const Sensor& sensor, std::span<const DepthFrame> frames,
                                     const FrameMeetings& meeting,
                                     std::optional<double> support_plane,
                                     const Suspicion& contradiction);

/// "12 %"
[[nodiscard]] std::string percent(double share);

}  // namespace viewgain::detail
