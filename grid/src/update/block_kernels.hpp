// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "viewgain/core/camera.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/grid/grid_snapshot.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// A camera for the projection of voxel centres.
struct ConeCamera {
  std::array<double, 12> T_camera_grid{};  ///< rows of [R | t]
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::array<double, 5> distortion{};
  bool distorted = false;
  /// Squared radius in the plane z = 1 at which the radial distortion folds back; points beyond are
  /// outside the image regardless of the polynomial.
  double fold_r2 = 0;
  std::int32_t width = 0, height = 0;

  ConeCamera() = default;
  ConeCamera(const PinholeCamera& camera, const Pose& T_camera_grid_pose);
};

/// Result of update() for a block.
struct BlockUpdate {
  LeafMask non_free{};   ///< after the update
  LeafMask crossed{};    ///< voxels with a miss in `deltas`
  bool uniform = false;  ///< all codes are equal
};

/// Loops over the 512 voxels of a block in leaf order (z fastest), with one set of functions per
/// instruction set. All give the same bits: + - × / sqrt, no fused multiply-add.
struct BlockKernels {
  /// Projects the voxel centres into the image, of the first `edge` along each axis; other entries
  /// of `deltas` are undefined. reach_taper holds two numbers per pixel: the range [m] below which
  /// a centre is crossed, and the length [m] before it over which a crossing loses its weight.
  /// deltas: 0..-8 steps, or kNoDelta. False: no deltas at all.
  bool (*project)(const ConeCamera& camera, const double* reach_taper, double voxel_size,
                  Index3 origin, int edge, std::int8_t* deltas);
  /// Applies deltas to codes (log_odds_code.hpp).
  void (*update)(const std::int8_t* deltas, bool literal, std::uint8_t* codes, BlockUpdate& result);
};

[[nodiscard]] const BlockKernels& block_kernels(Isa isa);

}  // namespace viewgain::detail
