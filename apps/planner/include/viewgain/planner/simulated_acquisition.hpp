// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
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

/// The pose that is reported for a camera at T_world_camera, off by `sigma`: Gaussian, independent,
/// fixed by seed and view. That of view 0 is exact: it defines the world's frame, which nothing
/// else could tell. Thread safe. Throws Error(invalid_argument), naming the value, if a sigma is
/// negative or not finite.
[[nodiscard]] VIEWGAIN_EXPORT Pose reported_pose(const Pose& T_world_camera, std::size_t view,
                                                 const PoseSigma& sigma, std::uint64_t seed);

/// DATAACQUISITION that goes where it is sent and reports a pose that is a little off. Thread
/// safety: one call at a time. A call throws what its camera's does and as reported_pose(), and
/// costs what its camera's does.
class VIEWGAIN_EXPORT MisreportedAcquisition : public DataAcquisition {
 public:
  /// Keeps the reference. The sigmas are checked by acquire().
  MisreportedAcquisition(DataAcquisition& camera, const PoseSigma& sigma, std::uint64_t seed)
      : camera_(camera), sigma_(sigma), seed_(seed) {}

  Measurements acquire(const Pose& T_world_camera, std::size_t view) override;

 private:
  DataAcquisition& camera_;
  PoseSigma sigma_;
  std::uint64_t seed_;
};

}  // namespace viewgain
