// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/range_calibration.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"

namespace viewgain {

/// Surroundings and errors of the simulation. By default there is only the mesh.
struct VIEWGAIN_EXPORT SimulationConfig {
  /// Diffuse sphere around the world's origin that stands for the room [m]; 0: none.
  double background_radius = 0;
  /// Adds Gaussian noise along the ray, from the sensor's model, and noise of the amplitude.
  bool noise = false;
  /// Seed of the noise; together with the frame index it determines every pixel.
  std::uint64_t seed = 1;
  /// Rays per pixel: sub_rays x sub_rays, 1..16. For sensors with a modulation frequency, the
  /// returns of a pixel mix as complex phasors, which creates flying pixels at depth edges. Other
  /// sensors use the centre ray only.
  int sub_rays = 1;
  /// Shifts all rays of a pixel by one random offset across the ray. The offset is Gaussian in both
  /// directions, with the noise model's lateral standard deviation. The reading (measured depth) is
  /// reported on the unshifted ray. Independent of `noise`.
  bool lateral_noise = false;
  /// Relative error of all ranges in all frames, like an error of the camera's calibration:
  /// measured ranges are 1 + scale_error times the true ones. In (-1, 1).
  double scale_error = 0;
  /// Wraps ranges to [0, c / (2 modulation_frequency)) if a pixel has a single ray; c is the speed
  /// of light. If a pixel has several rays, ranges always wrap, because the sum of the returns only
  /// has a phase.
  bool ambiguity = false;
  std::optional<double> support_plane{};  ///< height z of an infinite diffuse table [m], world
  /// Other diffuse objects, such as known obstacles; null: none.
  std::shared_ptr<const SurfaceScene> surroundings{};
};

/// A depth camera in front of a triangle mesh. Thread safety: acquire() is const and may run from
/// many threads; results do not depend on their number. Cost of acquire(): sub_rays² rays per
/// pixel, on all threads. The constructor calls PinholeCamera::ray() per pixel.
class VIEWGAIN_EXPORT SimulatedSensor {
 public:
  /// What the rays of one pixel hit, without noise.
  struct PixelTruth {
    float min_range = 0;      ///< smallest of all returns [m]; 0 if there is none
    float max_range = 0;      ///< largest of all returns [m]
    float nearest_range = 0;  ///< the return nearest to the reading [m]; 0 if there is no reading
    int returns = 0;          ///< number of rays that hit something
  };

  /// Throws Error(invalid_argument) for an invalid sensor or a configuration value out of bounds.
  SimulatedSensor(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
                  const SimulationConfig& config = {}, const ExecConfig& exec = {});
  ~SimulatedSensor();
  SimulatedSensor(SimulatedSensor&&) noexcept;
  SimulatedSensor& operator=(SimulatedSensor&&) noexcept;

  /// The depth frame from T_world_camera, with amplitudes (0 without a reading). Pixels below
  /// min_range or the sensor's least amplitude are invalid; pixels without a hit or beyond
  /// max_range are out of range. `frame_index` selects the noise: equal seed, index and pose give
  /// equal frames. Throws Error(invalid_argument) for a pose that is not rigid (1e-3).
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index = 0) const;

  /// As above, and what the rays of each pixel hit, row-major.
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index,
                                   std::vector<PixelTruth>& truth) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
