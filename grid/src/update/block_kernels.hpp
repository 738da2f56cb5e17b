// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
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

/// Which centres a pixel crosses, or one of several pixels, rounded outwards to single precision.
struct RangeBounds {
  float clear = 0;  ///< below this range all pixels cross at full weight [m]
  float reach = 0;  ///< from this range on no pixel crosses [m]

  /// Bounds of a pixel with this reach and taper [m] (Readings::reach_taper()).
  [[nodiscard]] static RangeBounds of(double reach, double taper) {
    constexpr double kOutwards = 2e-7;
    return {static_cast<float>(std::max(0.0, reach - taper) * (1 - kOutwards)),
            static_cast<float>(reach * (1 + kOutwards))};
  }
  /// As one number, for gathers: clear in the low half.
  [[nodiscard]] std::uint64_t packed() const {
    return std::bit_cast<std::uint32_t>(clear) | std::uint64_t{std::bit_cast<std::uint32_t>(reach)}
                                                     << 32U;
  }
  [[nodiscard]] static RangeBounds unpacked(std::uint64_t packed) {
    return {std::bit_cast<float>(static_cast<std::uint32_t>(packed)),
            std::bit_cast<float>(static_cast<std::uint32_t>(packed >> 32U))};
  }
};

/// A frame's pixels, in rows.
struct ConePixels {
  const double* reach_taper;    ///< Readings::reach_taper()
  const std::uint64_t* bounds;  ///< RangeBounds::packed(), one per pixel
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
  /// of `deltas` are undefined. A centre is crossed below its pixel's reach [m]; a crossing loses
  /// its weight over the taper [m] before it. deltas: 0..-8 steps, or kNoDelta. False: no deltas at
  /// all.
  bool (*project)(const ConeCamera& camera, const ConePixels& pixels, double voxel_size,
                  Index3 origin, int edge, std::int8_t* deltas);
  /// Applies deltas to codes (log_odds_code.hpp).
  void (*update)(const std::int8_t* deltas, bool literal, std::uint8_t* codes, BlockUpdate& result);
};

[[nodiscard]] const BlockKernels& block_kernels(Isa isa);

}  // namespace viewgain::detail
