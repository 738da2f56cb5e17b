// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// Pixels of about one range, and how their readings scatter along the ray, seen frontally.
struct VIEWGAIN_EXPORT NoiseStep {
  double range = 0;         ///< mean [m]
  double sigma_axial = 0;   ///< measured [m]
  double fitted_axial = 0;  ///< what the fitted model says [m]
  std::size_t pixels = 0;
};

/// A sensor with its noise as it was measured.
struct VIEWGAIN_EXPORT NoiseCalibrationResult {
  Sensor sensor;
  double sigma_lateral_px = 0;    ///< measured at jumps of depth [px]
  double edge_length = 0;         ///< of the jumps that told it [px]
  bool lateral_in_model = false;  ///< false: the model has no parameter of σ_lat, which stays t/fx
  bool ranges_tell_shape =
      false;                     ///< false: one factor, for want of ranges to fit two parameters to
  std::vector<NoiseStep> steps;  ///< by range
  double moving_share = 0;       ///< of the pixels, whose readings change with time
};

/// Measures how a depth camera's readings scatter, from frames of a static scene from one pose.
/// σ_ax is the scatter in time of pixels on smooth surfaces seen at less than 30°. σ_lat is that of
/// straight jumps of depth, where a pixel reads now the near and now the far side: p (1 - p),
/// summed across an edge, is σ / √π. Thread safety: one call at a time. Cost of adding a frame: a
/// copy; of solve(): some 200 operations a pixel, and the readings of a pixel sorted.
class VIEWGAIN_EXPORT NoiseCalibration {
 public:
  static constexpr std::size_t kLeastFrames = 30;

  /// The sensor's noise says which model is fitted; a `unit` [m] by which depths are rounded is
  /// taken off. Throws Error(invalid_argument) for a sensor that is not valid.
  NoiseCalibration(const Sensor& sensor, double unit);

  /// Throws Error(invalid_argument) for a frame of another size.
  void add(const DepthFrame& frame);

  /// Throws Error(invalid_argument) for under kLeastFrames frames, a scene or camera that moves,
  /// too few pixels on smooth surfaces, too short jumps of depth for σ_lat, and readings that
  /// hardly scatter.
  [[nodiscard]] NoiseCalibrationResult solve() const;

 private:
  Sensor sensor_;
  double unit_;
  std::vector<std::vector<float>> depths_;
};

}  // namespace viewgain
