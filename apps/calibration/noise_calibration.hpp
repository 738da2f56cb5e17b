// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {

/// Noise of the pixels at about one range, along the ray and at frontal incidence.
struct VIEWGAIN_EXPORT NoiseStep {
  double range = 0;         ///< mean [m]
  double sigma_axial = 0;   ///< measured [m]
  double fitted_axial = 0;  ///< from the fitted model [m]
  std::size_t pixels = 0;
};

/// A sensor with measured noise.
struct VIEWGAIN_EXPORT NoiseCalibrationResult {
  Sensor sensor;
  double sigma_lateral_px = 0;    ///< measured at depth jumps [px]
  double edge_length = 0;         ///< of the depth jumps used for it [px]
  bool lateral_in_model = false;  ///< false: the model has no parameter of σ_lat, which stays t/fx
  bool ranges_tell_shape = false;  ///< false: too few ranges for two parameters; fitted one factor
  std::vector<NoiseStep> steps;    ///< by range
  double moving_share = 0;         ///< fraction of pixels whose readings change with time
};

/// Measures the noise of a depth camera from frames of a static scene, all from one pose. σ_ax is
/// the variation over time of pixels on smooth surfaces seen at less than 30°. σ_lat comes from
/// straight depth jumps, where a pixel sometimes reads the near and sometimes the far side. If p is
/// the fraction of far readings, p (1 - p) summed across the edge is σ / √π. Thread safety: one
/// call at a time. Cost: add() copies the frame; solve() sorts each pixel's readings and takes
/// about 200 operations per pixel.
class VIEWGAIN_EXPORT NoiseCalibration {
 public:
  static constexpr std::size_t kLeastFrames = 30;

  /// The sensor's noise determines which model is fitted. Depths are rounded to `unit` [m]; this
  /// part of the noise is subtracted. Throws Error(invalid_argument) for an invalid sensor.
  NoiseCalibration(const Sensor& sensor, double unit);

  /// Throws Error(invalid_argument) for a frame of another size.
  void add(const DepthFrame& frame);

  /// Throws Error(invalid_argument) for fewer than kLeastFrames frames, a moving scene or camera,
  /// too few pixels on smooth surfaces, depth jumps too short for σ_lat, and readings with almost
  /// no noise.
  [[nodiscard]] NoiseCalibrationResult solve() const;

 private:
  Sensor sensor_;
  double unit_;
  std::vector<std::vector<float>> depths_;
};

}  // namespace viewgain
