// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/simulated_acquisition.hpp"

#include "viewgain/core/error.hpp"

namespace viewgain {

Measurements SimulatedAcquisition::acquire(const Pose& T_world_camera, std::size_t view) {
  if (frames_per_view_ == 0) {
    throw Error(ErrorCode::invalid_argument, "frames per view: 0 is not at least 1");
  }
  Measurements measurements{T_world_camera, {}};
  for (std::size_t i = 0; i < frames_per_view_; ++i) {
    measurements.frames.push_back(camera_.acquire(T_world_camera, view * frames_per_view_ + i));
    if (stop_.stop_requested()) break;
  }
  last_frame_ = measurements.frames.front();
  return measurements;
}

}  // namespace viewgain
