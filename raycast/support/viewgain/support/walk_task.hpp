// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace viewgain::detail {

/// Rays are traced in tiles of 4×4 pixels for any packet width, so that all instruction sets meet
/// the hits in the same order.
inline constexpr int kTileEdge = 4;
inline constexpr int kTileRays = kTileEdge * kTileEdge;

/// Limits of the rays of a view. Lengths in voxels, coordinates relative to the workspace's lowest
/// corner.
struct WalkLimits {
  std::array<float, 3> origin{};     ///< of the rays
  float min_range = 0;               ///< nearer hits do not count
  std::array<float, 3> workspace{};  ///< its size along x, y, z
  bool has_plane = false;            ///< whether a support plane ends descending rays
  std::array<float, 3> normal{};     ///< of the plane, grid frame, unit length, upwards
  float height = 0;                  ///< of the plane along the normal
};

/// A tile of rays to walk.
struct alignas(64) WalkTask {
  float dx[kTileRays], dy[kTileRays], dz[kTileRays];  ///< unit directions, grid frame
  float ix[kTileRays], iy[kTileRays], iz[kTileRays];  ///< 1 / direction; zero counts as 1e-20
  float near[kTileRays], far[kTileRays];              ///< part of each ray to walk [voxels]
  const float* solid_angle = nullptr;                 ///< of each ray [sr]
  std::uint32_t lanes = 0;                            ///< one bit per ray to walk
};

}  // namespace viewgain::detail
