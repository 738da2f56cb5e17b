// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "map/frame_meetings.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/frame_check.hpp"
#include "viewgain/planner/suspect_frames.hpp"

namespace viewgain::detail {

/// A frame whose share is at least this contradicts the others.
inline constexpr double kContradicting = 0.05;

/// Above these shares of all readings frames contradict one another. Right simulated frames have up
/// to 0.9 % in free space, at edges, and see past 0.2 %; a recorded room up to 1.3 % and 1.9 %.
inline constexpr double kInFree = 0.02, kSeenPast = 0.03;
/// Of fewer contradicting readings nothing is said.
inline constexpr std::size_t kEnoughContradictions = 20;
/// The same of a single frame with this many readings or more.
inline constexpr double kOfAFrame = 0.2;
inline constexpr std::size_t kEnoughReadings = 50;

/// The largest share of one frame's readings in others' free space, or of others' in its own.
[[nodiscard]] double largest_share(const FrameConsistency& found);

/// What is probably wrong with the frames `meeting` holds, of a map whose frames `found` counts;
/// without counts as far as the meetings tell.
[[nodiscard]] Suspicion suspicion_of(const Sensor& sensor, std::span<const DepthFrame> frames,
                                     const FrameMeetings& meeting,
                                     std::optional<double> support_plane,
                                     const FrameConsistency& found);

}  // namespace viewgain::detail
