// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// on_known: a reading of the support plane or of a known obstacle, which carves as far as it
/// reaches but is no hit.
enum class PixelKind : std::uint8_t { invalid, reading, out_of_range, on_known };

/// Noise spreads readings by this many sigma_ax.
inline constexpr double kTaperSigmas = 3.0;

/// The first stage of a frame: what its pixels, or the points of a cloud, say. Rays from one
/// origin, in one frame.
class Readings {
 public:
  [[nodiscard]] const Sensor& sensor() const { return sensor_; }
  [[nodiscard]] std::size_t size() const { return rays_.size(); }
  /// Pixels in a row of the image; 0 for a cloud.
  [[nodiscard]] int row_length() const { return row_length_; }
  [[nodiscard]] PixelKind kind(std::size_t pixel) const { return kinds_[pixel]; }
  [[nodiscard]] const std::vector<PixelKind>& kinds() const { return kinds_; }

  /// Where all rays begin [m].
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// A reading's point [m]; on the support plane too.
  [[nodiscard]] const Eigen::Vector3d& point(std::size_t pixel) const { return points_[pixel]; }
  /// Unit vector along the pixel's ray.
  [[nodiscard]] Eigen::Vector3d direction(std::size_t pixel) const {
    return rays_[pixel] / norms_[pixel];
  }
  [[nodiscard]] MeasurementSigmas sigmas(std::size_t pixel) const { return sigmas_[pixel]; }

  /// Reach and taper [m] of each pixel, one after the other; 0, 0 for invalid pixels. A voxel that
  /// is nearer than the reach is crossed. Within the taper before the reach the crossing weighs
  /// less (miss_weight()).
  [[nodiscard]] const std::vector<double>& reach_taper() const { return reach_taper_; }

 protected:
  explicit Readings(const Sensor& sensor) : sensor_(sensor) { sensor_.validate(); }
  ~Readings() = default;
  Readings(Readings&&) = default;
  Readings& operator=(Readings&&) = default;

  void resize(std::size_t count);
  /// What a pixel at this range says (NaN: invalid), with its reach and no taper yet.
  [[nodiscard]] PixelKind sort_by_range(std::size_t pixel, double range);

  Sensor sensor_;
  int row_length_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> rays_;
  std::vector<double> norms_;  ///< of the rays
  std::vector<PixelKind> kinds_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<MeasurementSigmas> sigmas_;
  std::vector<double> reach_taper_;
};

/// Readings and where they belong in a grid.
struct PlacedFrame {
  const Readings& readings;
  const Pose& T_grid_readings;
  const Pose& T_world_view;  ///< what the grid's views get
};

/// The box that holds every reading, those of the support plane left out, in the grid's frame [m];
/// nothing if there is none.
[[nodiscard]] std::optional<Box> bounds_of(const Readings& readings, const Pose& T_grid_readings);

}  // namespace viewgain::detail
