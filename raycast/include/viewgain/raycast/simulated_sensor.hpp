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

/// Surroundings and errors of a simulated camera. The default has none of them.
struct VIEWGAIN_EXPORT SimulationConfig {
  /// Radius of a diffuse sphere around the world's origin that simulates the room [m]; 0: none.
  double background_radius = 0;
  /// Adds noise to the amplitudes, and Gaussian noise along the ray, according to the sensor's
  /// noise model.
  bool noise = false;
  /// Seed of the noise.
  std::uint64_t seed = 1;
  /// A pixel has sub_rays x sub_rays rays; 1 to 16. For sensors with a modulation frequency, the
  /// returns of a pixel's rays are added as complex phasors, which creates flying pixels at depth
  /// edges. Other sensors use only the centre ray.
  int sub_rays = 1;
  /// Shifts all rays of a pixel by one random offset across the ray. The offset is Gaussian in both
  /// directions, with the lateral sigma of the noise model. The reading (measured depth) is
  /// reported on the unshifted ray. Independent of `noise`.
  bool lateral_noise = false;
  /// Relative error of all ranges, like that of a wrong calibration: measured ranges are 1 +
  /// scale_error times the true ones. In (-1, 1).
  double scale_error = 0;
  /// Wraps ranges to [0, unambiguous_range()). If a pixel has several rays, its range always wraps,
  /// because only the phase of the sum is known.
  bool ambiguity = false;
  std::optional<double> support_plane{};  ///< height z of an infinite diffuse table [m], world
  /// Further diffuse objects, such as known obstacles; null: none.
  std::shared_ptr<const SurfaceScene> surroundings{};
};

/// Simulates a depth camera in front of a triangle mesh. Thread safety: acquire() may run from many
/// threads. Results do not depend on the number of threads. Cost of acquire(): sub_rays² rays per
/// pixel, on all threads. The constructor calls PinholeCamera::ray() per pixel.
class VIEWGAIN_EXPORT SimulatedSensor {
 public:
  /// What the rays of one pixel hit, without noise. A return is a ray that hits something.
  struct PixelTruth {
    float min_range = 0;  ///< smallest range of the returns [m]; 0 if there are none
    float max_range = 0;  ///< largest range of the returns [m]; 0 if there are none
    /// Range of the return nearest to the reading [m]; 0 if there is no reading.
    float nearest_range = 0;
    int returns = 0;  ///< number of returns
  };

  /// Throws Error(invalid_argument) if the sensor is invalid or a value of `config` is out of
  /// bounds.
  SimulatedSensor(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
                  const SimulationConfig& config = {}, const ExecConfig& exec = {});
  ~SimulatedSensor();
  SimulatedSensor(SimulatedSensor&&) noexcept;
  SimulatedSensor& operator=(SimulatedSensor&&) noexcept;

  /// The depth frame from T_world_camera, with amplitudes, which are 0 where there is no reading.
  /// Pixels are invalid if their range is below min_range or their amplitude is below the minimum
  /// of the noise model. Pixels are out of range if their ray hits nothing up to max_range.
  /// `frame_index` selects the noise: the same seed, index and pose give the same frame. Throws
  /// Error(invalid_argument) if the pose is not rigid within 1e-3.
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index = 0) const;

  /// As above, and what the rays of each pixel hit, row-major.
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index,
                                   std::vector<PixelTruth>& truth) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
