// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "classic_rays.hpp"

#include <algorithm>
#include <bit>

#include "scene/scene_data.hpp"
#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
namespace {

// Shortens a tile's rays to where they meet an obstacle; in single precision, as all tracing of
// triangles.
void cut(const SceneData& data, const ClassicTable& table, const ClassicFrame& frame,
         ClassicTile& tile) {
  PoseFrame single;
  for (std::size_t a = 0; a < 3; ++a) {
    single.origin[a] = static_cast<float>(frame.origin[a] - table.offset[a]);
  }
  RayTile rays;
  alignas(64) float far[kTileRays];
  rays.valid = tile.valid;
  for (int lane = 0; lane < kTileRays; ++lane) {
    rays.dx[lane] = static_cast<float>(tile.dx[lane]);
    rays.dy[lane] = static_cast<float>(tile.dy[lane]);
    rays.dz[lane] = static_cast<float>(tile.dz[lane]);
    far[lane] = static_cast<float>(std::min(tile.far[lane], 4 * kFarthestCamera));
  }
  const std::array<float, kTileRays> before = std::to_array(far);
  data.tracing->obstacles->cut(single, rays, rays.valid, far);
  for (int lane = 0; lane < kTileRays; ++lane) {
    if (far[lane] < before[static_cast<std::size_t>(lane)]) {
      tile.far[lane] = std::min(tile.far[lane], static_cast<double>(far[lane]));
    }
  }
}

}  // namespace

std::optional<ClassicFrame> classic_frame(const VoxelScene& scene, const ClassicTable& table,
                                          const Pose& T_world_camera) {
  const std::optional<Pose> T_rigid = rigid_pose(T_world_camera);
  if (!T_rigid) return std::nullopt;
  const GridSnapshot& snapshot = scene.snapshot();
  const Pose T_grid_camera = snapshot.T_world_grid.inverse() * *T_rigid;
  const Eigen::Vector3d origin = T_grid_camera.translation() / snapshot.voxel_size -
                                 Eigen::Vector3d(table.base.x, table.base.y, table.base.z);
  const Eigen::Matrix3d R = T_grid_camera.rotation();
  ClassicFrame frame;
  for (int r = 0; r < 3; ++r) {
    frame.origin[static_cast<std::size_t>(r)] = origin[r];
    for (int c = 0; c < 3; ++c) frame.rotation[static_cast<std::size_t>(3 * r + c)] = R(r, c);
  }
  frame.sees_nothing = !(origin.cwiseAbs().maxCoeff() <= kFarthestCamera);
  return frame;
}

ClassicRays::ClassicRays(const PinholeCamera& camera, int pixel_stride)
    : tiles_(camera, pixel_stride), directions_(tiles_.directions.size()) {
  const std::vector<Eigen::Vector3d> table = camera.ray_table();
  for (std::size_t tile = 0; tile < tiles_.tile_count; ++tile) {
    count_ += static_cast<std::size_t>(std::popcount(tiles_.valid[tile]));
    for (int lane = 0; lane < kTileRays; ++lane) {
      Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
      if ((tiles_.valid[tile] >> lane & 1) != 0) {
        const std::size_t ray = tiles_.ray_index(tile, lane);
        const auto columns = static_cast<std::size_t>(tiles_.columns),
                   stride = static_cast<std::size_t>(pixel_stride);
        direction = table[ray / columns * stride * static_cast<std::size_t>(camera.width) +
                          ray % columns * stride]
                        .normalized();
      }
      for (int axis = 0; axis < 3; ++axis) {
        directions_[tile * 3 * kTileRays + static_cast<std::size_t>(axis * kTileRays + lane)] =
            direction[axis];
      }
    }
  }
}

void ClassicRays::place(const VoxelScene& scene, const ClassicTable& table,
                        const ClassicFrame& frame, std::size_t number, double far,
                        ClassicTile& tile) const {
  const double* x = &directions_[number * 3 * kTileRays];
  const double *y = x + kTileRays, *z = y + kTileRays;
  const auto& R = frame.rotation;
  for (int lane = 0; lane < kTileRays; ++lane) {
    tile.dx[lane] = R[0] * x[lane] + R[1] * y[lane] + R[2] * z[lane];
    tile.dy[lane] = R[3] * x[lane] + R[4] * y[lane] + R[5] * z[lane];
    tile.dz[lane] = R[6] * x[lane] + R[7] * y[lane] + R[8] * z[lane];
    tile.far[lane] = far;
  }
  tile.valid = tiles_.valid[number];
  tile.solid_angle = &tiles_.solid_angle[number * kTileRays];
  const SceneData& data = SceneAccess::data(scene);
  if (data.has_obstacles) cut(data, table, frame, tile);
}

}  // namespace viewgain::detail
