// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stop_token>
#include <utility>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain {

/// DATAACQUISITION of Algorithm 1 by a simulated camera: `frames_per_view` frames from each pose,
/// numbered on, so that view and frame fix the noise. When a stop is requested a view ends after
/// the frame that is being taken. Thread safety: one call at a time. Cost:
/// SimulatedSensor::acquire() a frame. Calls throw as that.
class VIEWGAIN_EXPORT SimulatedAcquisition : public DataAcquisition {
 public:
  /// `stop` ends a view after the frame at hand. `frames_per_view` must be at least 1, which is not
  /// checked.
  SimulatedAcquisition(SimulatedSensor camera, std::size_t frames_per_view, std::stop_token stop)
      : camera_(std::move(camera)), frames_per_view_(frames_per_view), stop_(std::move(stop)) {}

  Measurements acquire(const Pose& T_world_camera, std::size_t view) override;

  /// The first frame of the last view.
  [[nodiscard]] const DepthFrame& last_frame() const noexcept { return last_frame_; }

 private:
  SimulatedSensor camera_;
  std::size_t frames_per_view_;
  std::stop_token stop_;
  DepthFrame last_frame_;
};

}  // namespace viewgain
