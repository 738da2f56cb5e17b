// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A reading with the surface round it, camera frame; or a point of a map's surface.
struct Reading {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit, toward the camera
  double variance = 0;     ///< along the normal, as pairs count it [m²]
  double axial = 0;        ///< 1 sigma along the ray [m]
  double rim = 0;          ///< lateral sigmas, times how many of 25 pixels lie past a rim [m]
  int u = 0, v = 0;        ///< its pixel
  int level = 0;  ///< from this one on it takes part: 0 each 4th of a row, 1 each 2nd, 2 all
  std::uint32_t part = 0;  ///< of a map: neighbours, whose errors are alike, have the same
};

inline constexpr int kLevels = 3;

struct FrameReadings {
  std::vector<Reading> all;  ///< row by row
  int stride = 1;            ///< of the lattice of pixels that they are at
};

/// The readings of a frame on a lattice of pixels with about `max_readings` of them. The normal is
/// that of the plane through 5x5 readings within `radius` [m]; a reading without one, at the rim of
/// what is seen, is left out, and so is what is known (DepthFrame::known_depth). A smoothed point
/// is that of the plane through the 5x5 pixels round it, with a fifth of the noise; where some of
/// these have no reading it is less exact. `rays` is the camera's table.
[[nodiscard]] FrameReadings readings_of(const DepthFrame& frame, const Sensor& sensor,
                                        std::span<const Eigen::Vector3d> rays, double radius,
                                        bool are_smoothed, std::size_t max_readings,
                                        ThreadPool& pool);

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A frame as others see it, or what a map has where a frame may have been taken: readings with
/// normals, and at which pixel each is.
struct RegistrationView {
  PinholeCamera camera;
  std::vector<Reading> readings;
  int stride = 1;                ///< of the lattice [px]
  std::vector<std::int32_t> at;  ///< by row and column of the lattice, the reading; -1: none
  std::vector<float> depth;      ///< of each pixel [m], of a frame
  /// Of a map, else nullptr: what is free, and where this view is in it.
  const BeliefGrid* grid = nullptr;
  Pose T_world_view{};
  std::size_t parts = 0;  ///< of a map, see Reading::part

  /// The lattice without a reading; `camera` and `stride` are set.
  void clear_lattice();
  [[nodiscard]] int columns() const { return (camera.width + stride - 1) / stride; }
  [[nodiscard]] int rows() const { return (camera.height + stride - 1) / stride; }
  [[nodiscard]] std::size_t node(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(column);
  }
  /// The reading nearest to a pixel, within half the lattice's step; -1: none.
  [[nodiscard]] std::int32_t reading_at(double u, double v) const;
  /// Is it known that there is nothing round a point [camera frame, m]? A frame looks past it, by
  /// more than `margin` [m] at all pixels within `reach` [m] of its own, and at least at the eight
  /// round it; a map says free, there and `margin` nearer and farther.
  [[nodiscard]] bool looks_past(const Eigen::Vector3d& point, double margin, double reach) const;
};

/// Of a frame with these readings.
[[nodiscard]] RegistrationView view_of(const DepthFrame& frame, const PinholeCamera& camera,
                                       FrameReadings readings);

/// A view where it is, and by how much that may be off, 1 sigma.
struct PosedView {
  const RegistrationView& view;
  Pose T_world_view;
  PoseSigma slack;
  /// What a pose so far off does to a reading at this range [m²].
  [[nodiscard]] double slack_variance(double range) const {
    const double turned = slack.rotation * range;
    return slack.translation * slack.translation + turned * turned;
  }
};

/// What pairs say: of J w e, e = nᵀ(T_source s - T_target m), J its derivative by the translation
/// of the source's camera and the rotation about it, world axes. r is that by the width of rims.
struct PairSums {
  Matrix6 information = Matrix6::Zero();  ///< Σ w J Jᵀ
  Matrix6 agreed = Matrix6::Zero();       ///< that both normals agree on
  Vector6 gradient = Vector6::Zero();     ///< Σ w J e
  Vector6 rim_motion = Vector6::Zero();   ///< Σ w J r
  double rim_information = 0;             ///< Σ w r²
  double rim_gradient = 0;                ///< Σ w r e
  double squares = 0;                     ///< Σ e² [m²]
  std::size_t pairs = 0;
  std::vector<Vector6> of_parts{};  ///< the gradient by part, if the target is a map's
};

/// Of the readings of `source`, up to this level, that fall on one of `target`, along the surface
/// within `along` [m] of it. Readings are taken back along their normals by `rim_width` times their
/// `rim`. Marks in `is_paired`, if given, the readings that do.
[[nodiscard]] PairSums pair_sums(const PosedView& source, const PosedView& target, double along,
                                 double rim_width, int level, ThreadPool& pool,
                                 std::vector<std::uint8_t>* is_paired = nullptr);

}  // namespace viewgain::detail
