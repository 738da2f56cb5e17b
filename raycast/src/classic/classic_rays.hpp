// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "classic_walk.hpp"
#include "trace/ray_tile.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

struct ClassicTable;

/// A camera pose in table coordinates [voxels], in double precision.
struct ClassicFrame {
  std::array<double, 3> origin{};
  std::array<double, 9> rotation{};  ///< R_grid_camera, row by row
  bool sees_nothing = false;         ///< too far away, as PoseFrame
};

/// The pose in a table's coordinates; nothing if it is not finite or its rotation is off by more
/// than 1e-3.
[[nodiscard]] std::optional<ClassicFrame> classic_frame(const VoxelScene& scene,
                                                        const ClassicTable& table,
                                                        const Pose& T_world_camera);

/// A camera's rays in double precision, by tiles. Immutable.
class ClassicRays {
 public:
  ClassicRays(const PinholeCamera& camera, int pixel_stride);

  [[nodiscard]] const TileTable& tiles() const { return tiles_; }
  /// Those that a lens has.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// A tile of a view, each ray until `far` [voxels] or an obstacle of the scene.
  void place(const VoxelScene& scene, const ClassicTable& table, const ClassicFrame& frame,
             std::size_t number, double far, ClassicTile& tile) const;

 private:
  TileTable tiles_;
  std::vector<double> directions_;  // 48 a tile, as TileTable's
  std::size_t count_ = 0;
};

}  // namespace viewgain::detail
