// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// on_known: a reading of the support plane or of a known obstacle, which marks free space but is
/// not a hit.
enum class PixelKind : std::uint8_t { invalid, reading, out_of_range, on_known };

/// Noise spreads readings by this many sigma_ax.
inline constexpr double kTaperSigmas = 3.0;

/// First stage of a frame: the data of its pixels, or of the points of a cloud. Rays from one
/// origin, in one frame.
class Readings {
 public:
  [[nodiscard]] const Sensor& sensor() const { return sensor_; }
  [[nodiscard]] std::size_t size() const { return rays_.size(); }
  /// Pixels per row of the image; 0 for a cloud.
  [[nodiscard]] int row_length() const { return row_length_; }
  [[nodiscard]] PixelKind kind(std::size_t pixel) const { return kinds_[pixel]; }
  [[nodiscard]] const std::vector<PixelKind>& kinds() const { return kinds_; }

  /// Origin of all rays [m].
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// Position of a reading [m], also on the support plane.
  [[nodiscard]] const Eigen::Vector3d& point(std::size_t pixel) const { return points_[pixel]; }
  /// Unit vector along the pixel's ray.
  [[nodiscard]] Eigen::Vector3d direction(std::size_t pixel) const {
    return rays_[pixel] / norms_[pixel];
  }
  /// Of readings in the workspace.
  [[nodiscard]] MeasurementSigmas sigmas(std::size_t pixel) const { return sigmas_[pixel]; }

  /// For kernels: all rays, their norms, all sigmas.
  [[nodiscard]] std::span<const Eigen::Vector3d> rays() const { return rays_; }
  [[nodiscard]] const std::vector<double>& norms() const { return norms_; }
  [[nodiscard]] const std::vector<MeasurementSigmas>& all_sigmas() const { return sigmas_; }
  /// Depths along z of an image's readings, otherwise NaN, with a border of kDepthBorder pixels of
  /// NaN.
  static constexpr int kDepthBorder = 2;
  [[nodiscard]] const double* depths() const { return depths_.data(); }

  /// Reach and taper [m] of each pixel, alternating; 0, 0 for invalid pixels. A voxel nearer than
  /// the reach is crossed. Within the taper before the reach the crossing weighs less
  /// (miss_weight()).
  [[nodiscard]] const std::vector<double>& reach_taper() const { return reach_taper_; }

 protected:
  explicit Readings(const Sensor& sensor) : sensor_(sensor) { sensor_.validate(); }
  ~Readings() = default;
  Readings(Readings&&) = default;
  Readings& operator=(Readings&&) = default;

  void resize(std::size_t count);
  /// Kind of a pixel at this range (NaN: invalid), with its reach and no taper yet.
  [[nodiscard]] PixelKind sort_by_range(std::size_t pixel, double range);

  Sensor sensor_;
  int row_length_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::span<const Eigen::Vector3d> rays_;  ///< owned by the derived class
  std::vector<double> norms_;              ///< of the rays
  std::vector<PixelKind> kinds_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<MeasurementSigmas> sigmas_;
  std::vector<double> reach_taper_;
  std::vector<double> depths_;
};

/// Readings and their place in a grid.
struct PlacedFrame {
  const Readings& readings;
  const Pose& T_grid_readings;
  const Pose& T_world_view;  ///< appended to the grid's views
};

/// The box that contains all readings except those of the support plane, grid frame [m]; empty if
/// there are none.
[[nodiscard]] std::optional<Box> bounds_of(const Readings& readings, const Pose& T_grid_readings);

}  // namespace viewgain::detail
