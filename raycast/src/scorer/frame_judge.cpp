// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scorer/frame_judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "viewgain/core/error.hpp"
#include "viewgain/support/frame_identity.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {
namespace {

// Depths in millimetres would all be out of range and mark the object as free. If some depths are
// near, a single far value may mean "no reading".
bool has_metres(const DepthFrame& frame, const Sensor& sensor) {
  constexpr double kFar = 10;        // times max_range
  constexpr std::size_t kMost = 19;  // far readings for each near one
  std::size_t near = 0, far = 0;
  float least = DepthFrame::kOutOfRange, most = 0;
  for (const float z : frame.depth) {
    if (!(z > 0) || !std::isfinite(z)) continue;
    if (static_cast<double>(z) <= kFar * sensor.max_range) {
      ++near;
      continue;
    }
    ++far;
    least = std::min(least, z);
    most = std::max(most, z);
  }
  return far == 0 || far < kMost * near || (near > 0 && least == most);
}

}  // namespace

FrameVerdict judged(const Measurements& measurements, const Sensor& sensor) {
  for (const double sigma :
       {measurements.pose_sigma.translation, measurements.pose_sigma.rotation}) {
    if (std::isfinite(sigma) && sigma >= 0) continue;
    refuse("pose_sigma must be at least 0 and finite, not " + short_text(sigma));
  }
  for (const DepthFrame& frame : measurements.frames) check_identity(frame.identity);
  if (!rigid_pose(measurements.T_world_camera)) return FrameVerdict::lost_pose;
  try {
    for (const DepthFrame& frame : measurements.frames) check_frame_size(frame, sensor.camera);
  } catch (const Error&) {
    return FrameVerdict::wrong_size;
  }
  const auto& frames = measurements.frames;
  const bool is_in_metres = std::all_of(frames.begin(), frames.end(), [&](const DepthFrame& frame) {
    return has_metres(frame, sensor);
  });
  return is_in_metres ? FrameVerdict::used : FrameVerdict::not_metres;
}

}  // namespace viewgain::detail
