// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "registration/registration_pairs.hpp"
#include "registration/registration_readings.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::detail {

/// A frame as its neighbours see it: readings with normals, and at which pixel each is.
class AlignedView {
 public:
  AlignedView(const DepthFrame& frame, const PinholeCamera& camera, std::vector<Reading> readings);

  [[nodiscard]] const std::vector<Reading>& readings() const noexcept { return readings_; }
  /// Of the reading along its normal [m²].
  [[nodiscard]] double variance(std::size_t reading) const { return variances_[reading]; }
  /// The reading nearest to a pixel, within half the lattice's step; -1: none.
  [[nodiscard]] std::int32_t reading_at(double u, double v) const;
  /// Does the frame look past a point [camera frame, m], by more than `margin` [m] at all pixels
  /// within `reach` [m] of its own, and at least at the eight round it?
  [[nodiscard]] bool looks_past(const Eigen::Vector3d& point, double margin, double reach) const;

  [[nodiscard]] const PinholeCamera& camera() const noexcept { return camera_; }

 private:
  [[nodiscard]] float depth_at(int u, int v) const {
    return depth_[static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.width) +
                  static_cast<std::size_t>(u)];
  }

  PinholeCamera camera_;
  std::vector<Reading> readings_;
  std::vector<double> variances_;
  std::vector<float> depth_;
  int stride_ = 1;  // [px]
  int columns_ = 0, rows_ = 0;
  std::vector<std::int32_t> at_;
};

/// Of two frames. r is the derivative of e by the width of rims.
struct ViewSums : PairSums {
  Vector6 rim_motion = Vector6::Zero();  ///< Σ w J r
  double rim_information = 0;            ///< Σ w r²
  double rim_gradient = 0;               ///< Σ w r e
};

/// What the readings of `source` say that fall on one of `target`: sums by the motion of the
/// source's camera, world axes. The gates say how far either may be off; those along the surface
/// and of normals are the source's. Readings are taken back along their normals by `rim_width`
/// times their `rim`. Marks in `is_paired`, if given, the readings that do.
[[nodiscard]] ViewSums pair_sums(const AlignedView& source, const Pose& T_world_source,
                                 const PairGates& source_gates, const AlignedView& target,
                                 const Pose& T_world_target, const PairGates& target_gates,
                                 double rim_width, int level,
                                 std::vector<std::uint8_t>* is_paired = nullptr);

}  // namespace viewgain::detail
