// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>

#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {

/// First hit of a ray.
struct RayReturn {
  double range = std::numeric_limits<double>::infinity();  ///< [m]; infinity: nothing
  double cos_incidence = 0;
};

/// The object and its surroundings.
struct SimulatedRoom {
  std::shared_ptr<const SurfaceScene> object;
  double background_radius = 0;                      ///< of a sphere around the origin [m]; 0: none
  std::optional<double> support_plane;               ///< height of an infinite table [m]
  std::shared_ptr<const SurfaceScene> surroundings;  ///< may be null

  /// The first returns of rays without a range limit, world frame; one per ray.
  void first_returns(std::span<const SurfaceScene::Ray> rays, std::span<RayReturn> returns) const;
};

/// Uses of random numbers in a pixel.
enum class RandomStream : std::uint64_t { axial, lateral_x, lateral_y, amplitude };

/// The random numbers of one pixel of one frame.
class PixelRandom {
 public:
  PixelRandom(std::uint64_t seed, std::uint64_t frame, std::uint64_t pixel)
      : base_(mix64(mix64(mix64(seed) ^ frame) ^ pixel)) {}

  /// A standard normal number (Box-Muller), independent for each stream.
  [[nodiscard]] double normal(RandomStream stream) const {
    const std::uint64_t a = stream == RandomStream::axial
                                ? base_
                                : mix64(base_ ^ mix64(static_cast<std::uint64_t>(stream)));
    const std::uint64_t b = mix64(a);
    const double u = (static_cast<double>(a >> 11U) + 0.5) * 0x1.0p-53;
    const double v = static_cast<double>(b >> 11U) * 0x1.0p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::uint64_t base_;
};

/// What a pixel measures.
struct PixelReading {
  double range = 0;          ///< [m]
  double cos_incidence = 0;  ///< derived from the amplitude, in [0, 1]
  double amplitude = 0;      ///< [m⁻²]
  double sigma = 0;          ///< of the noise along the ray [m]
};

/// How the sensor measures the returns in a pixel: mixing, ambiguity, errors.
class TofPixel {
 public:
  TofPixel(const Sensor& sensor, const SimulationConfig& config);

  /// Whether the pixel's returns mix. Otherwise only the centre ray is used.
  [[nodiscard]] bool mixes() const { return mixes_; }

  /// Measures one return; a range of infinity means no return.
  [[nodiscard]] PixelReading single(const RayReturn& hit) const;

  /// Measures returns of rays that cover the pixel evenly: sums their phasors A exp(i phi), with A
  /// = cosθ / t² and phi = 4 pi f t / c. The range is infinity if no ray hits anything.
  [[nodiscard]] PixelReading mixed(std::span<const RayReturn> hits) const;

  /// Adds the systematic error and the noise, and subtracts the calibration.
  [[nodiscard]] PixelReading disturbed(PixelReading reading, const PixelRandom& random) const;

  /// Whether the pixel is too dark to be a reading.
  [[nodiscard]] bool too_dark(const PixelReading& reading) const {
    return reading.amplitude < min_amplitude_;
  }

 private:
  [[nodiscard]] double folded(double range) const;
  /// Standard deviation of the noise; 0 if noise is off.
  [[nodiscard]] double sigma_at(double range, double cos_incidence) const;

  const Sensor& sensor_;
  const SimulationConfig& config_;
  double unambiguous_range_;  ///< [m], infinity for sensors without a modulation frequency
  bool mixes_;
  bool folds_;
  double min_amplitude_ = 0;  ///< [m⁻²]
};

}  // namespace viewgain::detail
