// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain {

/// By how much reported poses are off: Gaussian, independent, about the camera's centre.
struct VIEWGAIN_EXPORT PoseNoise {
  double sigma_translation = 0;  ///< in each axis [m]
  double sigma_rotation = 0;     ///< of each component of the rotation vector [rad]
  std::uint64_t seed = 1;        ///< with the view's number it fixes the error
};

/// The pose that is reported for a camera at T_world_camera. That of view 0 is exact: it defines
/// the world's frame, which nothing else could tell. Thread safe. Throws Error(invalid_argument),
/// naming the value, if a sigma is negative or not finite.
[[nodiscard]] VIEWGAIN_EXPORT Pose reported_pose(const Pose& T_world_camera, std::size_t view,
                                                 const PoseNoise& noise);

/// DATAACQUISITION that goes where it is sent and reports a pose that is a little off. Thread
/// safety: one call at a time. A call throws what its camera's does and as reported_pose(), and
/// costs what its camera's does.
class VIEWGAIN_EXPORT MisreportedAcquisition : public DataAcquisition {
 public:
  /// Keeps the reference. The noise is checked by acquire().
  MisreportedAcquisition(DataAcquisition& camera, const PoseNoise& noise)
      : camera_(camera), noise_(noise) {}

  Measurements acquire(const Pose& T_world_camera, std::size_t view) override;

 private:
  DataAcquisition& camera_;
  PoseNoise noise_;
};

}  // namespace viewgain
