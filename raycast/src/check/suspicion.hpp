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

/// A frame whose share is at least this contradicts the others.
inline constexpr double kContradicting = 0.05;

/// Above these shares of all readings frames contradict one another. Right simulated frames have up
/// to 0.9 % in free space, at edges, and see past 0.2 %; a recorded room up to 1.6 % and 3.6 %.
inline constexpr double kInFree = 0.025, kSeenPast = 0.05;
/// Of fewer contradicting readings nothing is said.
inline constexpr std::size_t kEnoughContradictions = 20;
/// The same of a single frame with this many readings or more.
inline constexpr double kOfAFrame = 0.2;
inline constexpr std::size_t kEnoughReadings = 50;

/// Of this many frames or more, the median displacement is over this many times what is declared,
/// and over this part of a voxel. A recorded room: 1.0 times, parts of it up to 1.4.
inline constexpr double kDisplaced = 2, kOfAVoxel = 0.15;
inline constexpr std::size_t kEnoughFrames = 5;

/// The largest share of one frame's readings in others' free space, or of others' in its own, of
/// frames with enough readings.
[[nodiscard]] double largest_share(const FrameConsistency& found);

/// Is a displacement well over the one that the declared errors explain, and over a small part of a
/// voxel? All in [m].
[[nodiscard]] bool is_displaced(double displacement, double expected, double voxel_size);

/// Whether the frames of a map with this voxel size [m] contradict one another, and how: kinds
/// same_image, contradiction and displacement.
[[nodiscard]] Suspicion suspect_contradiction(const FrameConsistency& found, double voxel_size);

/// What is probably wrong with the frames `meeting` holds; `contradiction` where no better reason
/// is found.
[[nodiscard]] Suspicion suspicion_of(const Sensor& sensor, std::span<const DepthFrame> frames,
                                     const FrameMeetings& meeting,
                                     std::optional<double> support_plane,
                                     const Suspicion& contradiction);

/// "12 %"
[[nodiscard]] std::string percent(double share);

}  // namespace viewgain::detail
