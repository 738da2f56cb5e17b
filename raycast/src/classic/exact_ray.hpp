// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "classic_table.hpp"
#include "trace/ray_tile.hpp"

namespace viewgain::detail {

struct ClassicTile;
struct ClassicView;

/// Where a ray goes from a cube.
struct ExactStep {
  std::array<std::int32_t, 3> beyond{};  ///< the voxel that it comes to
  std::int32_t voxels = 1;               ///< how many it met of the cube
  bool has_length = false;               ///< did it do more than touch it?
  bool goes_on = false;
};

/// A packet's rays in double precision: where they begin and end, and steps that single precision
/// cannot make. Plane distances are (plane - origin) / direction each time, never added up.
struct ExactRays {
  alignas(64) float near[kTileRays];  ///< where rays begin
  alignas(64) float far[kTileRays];   ///< where they end
  alignas(
      64) float inverse[3][kTileRays];  ///< of their directions; ±1e30 where they stay in a voxel
  /// Error of a distance along the ray that does not grow with it.
  alignas(64) float error[kTileRays];
  alignas(64) std::int32_t voxel[3][kTileRays];  ///< where they begin
  double begin_at[kTileRays], end_at[kTileRays];
  unsigned active = 0;  ///< a bit a ray that goes anywhere

  /// The parts of rays lane0 to lane0 + count - 1 of a tile within the workspace and its ranges.
  void begin(const ClassicView& view, const ClassicTile& tile, int lane0, int count);

  /// Where a ray enters a voxel that it comes to [voxels along the ray].
  [[nodiscard]] double enters(int lane, const std::array<std::int32_t, 3>& v) const;

  /// The step from a voxel out of the aligned cube round it.
  [[nodiscard]] ExactStep step(int lane, const std::array<std::int32_t, 3>& v,
                               std::int32_t edge) const;

 private:
  [[nodiscard]] double at_plane(int lane, std::size_t a, std::int32_t plane) const;

  const ClassicView* view_ = nullptr;
  const double* directions_[3] = {};
};

}  // namespace viewgain::detail
