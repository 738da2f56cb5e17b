// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "random_normal.hpp"
#include "simulated_room.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"

namespace viewgain::detail {

/// What a pixel measures.
struct PixelReading {
  double range = 0;          ///< [m]
  double cos_incidence = 0;  ///< as the amplitude tells it, in [0, 1]
  double amplitude = 0;      ///< [m⁻²]
  double sigma = 0;          ///< of the noise along the ray, by where the light comes from [m]
};

/// The sensor's view of the returns in a pixel: mixing, ambiguity, errors.
class TofPixel {
 public:
  TofPixel(const Sensor& sensor, const SimulationConfig& config);

  /// Do the pixel's returns mix? Otherwise the centre ray stands for the pixel.
  [[nodiscard]] bool mixes() const { return mixes_; }

  /// One return, with infinity for nothing.
  [[nodiscard]] PixelReading single(const RayReturn& hit) const;

  /// Returns of rays that cover the pixel evenly, as the sum of their phasors A exp(i phi),
  /// A = cosθ / t², phi = 4 pi f t / c. A range of infinity if no ray meets anything.
  [[nodiscard]] PixelReading mixed(std::span<const RayReturn> hits) const;

  /// Adds the systematic error and the noise, and takes the calibration off.
  [[nodiscard]] PixelReading disturbed(PixelReading reading, const PixelRandom& random) const;

  /// Too dark to be a reading?
  [[nodiscard]] bool too_dark(const PixelReading& reading) const {
    return reading.amplitude < min_amplitude_;
  }

 private:
  [[nodiscard]] double folded(double range) const;
  /// Of the noise; 0 without.
  [[nodiscard]] double sigma_at(double range, double cos_incidence) const;

  const Sensor& sensor_;
  const SimulationConfig& config_;
  double unambiguous_range_;  ///< [m], infinity for sensors without a modulation frequency
  bool mixes_;
  bool folds_;
  double min_amplitude_ = 0;  ///< [m⁻²]
};

}  // namespace viewgain::detail
