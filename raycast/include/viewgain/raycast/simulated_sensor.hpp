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

/// What surrounds the object and what disturbs the reading. Everything beyond the mesh is off by
/// default.
struct VIEWGAIN_EXPORT SimulationConfig {
  double background_radius =
      0;  ///< diffuse sphere round the world's origin that stands for the room [m]; 0: none
  bool noise = false;  ///< Gaussian noise along the ray by the sensor's model, and of the amplitude
  std::uint64_t seed = 1;  ///< of the noise; with the frame's index it fixes every pixel
  /// A pixel is sub_rays x sub_rays rays, 1..16. For sensors with a modulation frequency their
  /// returns mix as complex phasors, which makes flying pixels at jumps of depth. Others have no
  /// phase to mix: the ray of the centre stands for the pixel whatever the number.
  int sub_rays = 1;
  /// The rays of a pixel are displaced together, by a Gaussian of the model's lateral sigma in each
  /// of the two directions across the ray (at the range of the centre's return, at max_range where
  /// there is none): the reading is of a place beside the ray but reported on it. Needs no `noise`.
  bool lateral_noise = false;
  /// Ranges read 1 + scale_error times what they are: as the camera's calibration may be off, the
  /// same in all frames. In (-1, 1).
  double scale_error = 0;
  /// Ranges fold back to [0, c / (2 modulation_frequency)). Always so where returns mix, as their
  /// sum knows only the phase; this makes single rays do so too.
  bool ambiguity = false;
  std::optional<double> support_plane{};  ///< height z of a diffuse table without end [m], world
  /// What else stands there, say known obstacles, diffuse; null: nothing.
  std::shared_ptr<const SurfaceScene> surroundings{};
};

/// A depth camera in front of a triangle mesh. Thread safety: acquire() is const and may run from
/// many threads; results do not depend on them. Cost of acquire(): sub_rays² rays a pixel, on all
/// threads. The constructor calls PinholeCamera::ray() for each pixel.
class VIEWGAIN_EXPORT SimulatedSensor {
 public:
  /// What the rays of one pixel met, without noise.
  struct PixelTruth {
    float min_range = 0;      ///< of all returns [m]; 0 if there is none
    float max_range = 0;      ///< [m]
    float nearest_range = 0;  ///< the return nearest to the reading [m]; 0 if there is no reading
    int returns = 0;          ///< how many rays met something
  };

  /// Throws Error(invalid_argument) for a sensor that is not valid or a value of the configuration
  /// out of its bounds.
  SimulatedSensor(std::shared_ptr<const SurfaceScene> scene, const Sensor& sensor,
                  const SimulationConfig& config = {}, const ExecConfig& exec = {});
  ~SimulatedSensor();
  SimulatedSensor(SimulatedSensor&&) noexcept;
  SimulatedSensor& operator=(SimulatedSensor&&) noexcept;

  /// The depth frame seen from T_world_camera, with amplitudes (0 where there is no reading). A
  /// pixel whose range is below min_range is invalid, as is one under the sensor's least amplitude;
  /// nothing hit, or farther than max_range, is out of range. `frame_index` picks the noise: equal
  /// seed, index and pose give equal frames. Throws Error(invalid_argument) for a pose that is not
  /// rigid (1e-3).
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index = 0) const;

  /// The same, and what each pixel's rays met, row by row.
  [[nodiscard]] DepthFrame acquire(const Pose& T_world_camera, std::uint64_t frame_index,
                                   std::vector<PixelTruth>& truth) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
