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

/// DATAACQUISITION of Algorithm 1 (Foix et al. 2012) with a simulated camera: takes
/// `frames_per_view` frames from each pose. Frames are numbered consecutively, and the number
/// determines the noise. Thread safety: one call at a time. Errors and cost per frame: see
/// SimulatedSensor::acquire().
class VIEWGAIN_EXPORT SimulatedAcquisition : public DataAcquisition {
 public:
  /// `stop` ends a view after the current frame. `frames_per_view` must be at least 1 (unchecked).
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

/// The pose that an inexact robot reports for a camera at T_world_camera. Its errors are
/// independent and Gaussian, with standard deviations `sigma`; `seed` and `view` determine them.
/// View 0 is exact, because it defines the world frame. Thread safe. Throws Error(invalid_argument)
/// naming the value if a sigma is negative or not finite.
[[nodiscard]] VIEWGAIN_EXPORT Pose reported_pose(const Pose& T_world_camera, std::size_t view,
                                                 const PoseSigma& sigma, std::uint64_t seed);

/// DATAACQUISITION that reports slightly wrong poses. Thread safety: one call at a time. Throws
/// whatever its camera and reported_pose() throw. Costs the same as its camera.
class VIEWGAIN_EXPORT MisreportedAcquisition : public DataAcquisition {
 public:
  /// Keeps a reference to the camera. acquire() checks the sigmas.
  MisreportedAcquisition(DataAcquisition& camera, const PoseSigma& sigma, std::uint64_t seed)
      : camera_(camera), sigma_(sigma), seed_(seed) {}

  Measurements acquire(const Pose& T_world_camera, std::size_t view) override;

 private:
  DataAcquisition& camera_;
  PoseSigma sigma_;
  std::uint64_t seed_;
};

}  // namespace viewgain
