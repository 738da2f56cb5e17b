// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain {

/// What surrounds the object and what disturbs the reading.
struct SimulationConfig {
  double background_radius =
      0;  ///< diffuse sphere round the world's origin that stands for the room [m]; 0: none
  bool noise = false;      ///< Gaussian axial noise by the sensor's model
  std::uint64_t seed = 1;  ///< of the noise; with the frame's index it fixes every pixel
};

/// A depth camera in front of a triangle mesh.
/// Thread safety: acquire() is const and may run from many threads; results do not depend on them.
class SimulatedSensor {
 public:
  /// Throws Error(invalid_argument) for a sensor that is not valid or a negative background radius.
  SimulatedSensor(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
                  const SimulationConfig& config = {}, const ExecConfig& exec = {});
  ~SimulatedSensor();
  SimulatedSensor(SimulatedSensor&&) noexcept;
  SimulatedSensor& operator=(SimulatedSensor&&) noexcept;

  /// The depth frame seen from T_world_camera. A pixel whose true range is below min_range is
  /// invalid; nothing hit, or farther than max_range, is out of range. `frame_index` picks the
  /// noise: equal seed, index and pose give equal frames. Throws Error(invalid_argument) for a pose
  /// that is not rigid (1e-3).
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index = 0) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
