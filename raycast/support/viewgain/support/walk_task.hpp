// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace viewgain::detail {

/// Rays are traced in tiles of 4×4 pixels, whatever the packet width of the CPU, so that every
/// instruction set meets the hits in the same order.
inline constexpr int kTileEdge = 4;
inline constexpr int kTileRays = kTileEdge * kTileEdge;

/// Where the rays of a view may go. Lengths in voxels, coordinates relative to the workspace's
/// lowest corner.
struct WalkLimits {
  std::array<float, 3> origin{};     ///< of the rays
  float min_range = 0;               ///< nothing nearer counts
  std::array<float, 3> workspace{};  ///< its size along x, y, z
  bool has_plane = false;            ///< a support plane, at which rays that go down end
  std::array<float, 3> normal{};     ///< of the plane, grid frame, unit length, upwards
  float height = 0;                  ///< of the plane along the normal
};

/// A tile of rays that are to be walked.
struct alignas(64) WalkTask {
  float dx[kTileRays], dy[kTileRays], dz[kTileRays];  ///< unit directions, grid frame
  float ix[kTileRays], iy[kTileRays], iz[kTileRays];  ///< 1 / direction; zero counts as 1e-20
  float near[kTileRays], far[kTileRays];              ///< from where to where [voxels]
  const float* solid_angle = nullptr;                 ///< what each ray stands for [sr]
  std::uint32_t lanes = 0;                            ///< a bit a ray that is to be walked
};

}  // namespace viewgain::detail
