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

/// A reading with the surrounding surface, camera frame; or a point of a map's surface.
struct Reading {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit, towards the camera
  double variance = 0;     ///< variance along the normal in pairs [m²]
  double axial = 0;        ///< 1 sigma along the ray [m]
  double rim = 0;          ///< lateral sigmas, times the number of the 25 pixels past a rim [m]
  int u = 0, v = 0;        ///< its pixel
  int level = 0;           ///< level from which it is used: 0 each 4th of a row, 1 each 2nd, 2 all
  std::uint32_t part = 0;  ///< of a map: neighbours with correlated errors have the same
};

inline constexpr int kLevels = 3;

struct FrameReadings {
  std::vector<Reading> all;  ///< row by row
  int stride = 1;            ///< of the lattice of their pixels
};

/// The readings of a frame on a lattice of pixels with about `max_readings` of them. The normal is
/// that of the plane through 5x5 readings within `radius` [m]. Omits readings without one, at the
/// rims of the visible surface, and known objects (DepthFrame::known_depth). A smoothed point is
/// that of the plane through the 5x5 pixels around it, with a fifth of the noise; less exact where
/// some of these have no reading. `rays` is the camera's table.
[[nodiscard]] FrameReadings readings_of(const DepthFrame& frame, const Sensor& sensor,
                                        std::span<const Eigen::Vector3d> rays, double radius,
                                        bool are_smoothed, std::size_t max_readings,
                                        ThreadPool& pool);

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A frame as others see it, or the map's surface at a frame's possible poses: readings with
/// normals, and their pixels.
struct RegistrationView {
  PinholeCamera camera;
  std::vector<Reading> readings;
  int stride = 1;  ///< of the lattice [px]
  std::vector<std::int32_t>
      at;                    ///< index of the reading by row and column of the lattice; -1: none
  std::vector<float> depth;  ///< of each pixel [m], of a frame
  /// For a map, otherwise nullptr: its free space, and this view's pose in it.
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
  /// The reading nearest to a pixel, within half a lattice step; -1: none.
  [[nodiscard]] std::int32_t reading_at(double u, double v) const;
  /// Whether the space around a point [camera frame, m] is known to be free. A frame must see more
  /// than `margin` [m] past the point, at the eight neighbouring pixels and at all pixels within
  /// `reach` [m]. A map must be free at the point, and `margin` before and behind it.
  [[nodiscard]] bool looks_past(const Eigen::Vector3d& point, double margin, double reach) const;
};

/// View of a frame with these readings.
[[nodiscard]] RegistrationView view_of(const DepthFrame& frame, const PinholeCamera& camera,
                                       FrameReadings readings);

/// A view at its pose, and the pose's uncertainty, 1 sigma.
struct PosedView {
  const RegistrationView& view;
  Pose T_world_view;
  PoseSigma slack;
  /// Effect of this pose uncertainty on a reading at this range [m²].
  [[nodiscard]] double slack_variance(double range) const {
    const double turned = slack.rotation * range;
    return slack.translation * slack.translation + turned * turned;
  }
};

/// Sums over pairs of J w e, e = nᵀ(T_source s - T_target m), with J its derivative by the
/// translation of the source's camera and the rotation about it, world axes. r is the derivative by
/// the rims' width.
struct PairSums {
  Matrix6 information = Matrix6::Zero();  ///< Σ w J Jᵀ
  Matrix6 agreed = Matrix6::Zero();       ///< information that both normals agree on
  Vector6 gradient = Vector6::Zero();     ///< Σ w J e
  Vector6 rim_motion = Vector6::Zero();   ///< Σ w J r
  double rim_information = 0;             ///< Σ w r²
  double rim_gradient = 0;                ///< Σ w r e
  double squares = 0;                     ///< Σ e² [m²]
  std::size_t pairs = 0;
  std::vector<Vector6> of_parts{};  ///< gradient by part, if the target is a map's
};

/// Pairs of the readings of `source`, up to this level, with readings of `target` onto which they
/// project, within `along` [m] along the surface. Moves readings back along their normals by
/// `rim_width` times their `rim`. Marks the paired readings in `is_paired`, if given.
[[nodiscard]] PairSums pair_sums(const PosedView& source, const PosedView& target, double along,
                                 double rim_width, int level, ThreadPool& pool,
                                 std::vector<std::uint8_t>* is_paired = nullptr);

}  // namespace viewgain::detail
