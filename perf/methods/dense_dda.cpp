// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "dense_dda.hpp"

#include <vector>

#include "dense_grid.hpp"

namespace viewgain::bench {
namespace {

class DenseDda final : public TraceMethod {
 public:
  explicit DenseDda(const TraceTask& task)
      : TraceMethod("dense_dda", task.sensor.camera.ray_table().size()),
        grid_(task.map),
        table_(task.sensor.camera, 1),
        tracer_(dense_tile_tracer(select_isa())),
        T_grid_world_(task.map.T_world_grid.inverse()),
        voxel_size_(task.map.voxel_size),
        base_(task.map.min_index.x, task.map.min_index.y, task.map.min_index.z),
        min_range_(static_cast<float>(task.sensor.min_range / task.map.voxel_size)),
        max_range_(static_cast<float>(task.sensor.max_range / task.map.voxel_size)) {}

  void trace(const Pose& T_world_camera, std::span<Ending> endings) const override {
    const detail::PoseFrame frame = frame_of(T_world_camera);
    alignas(64) std::array<Ending, detail::kTileRays> tile_endings;
    for (std::size_t tile = 0; tile < table_.tile_count; ++tile) {
      tracer_(grid_, table_, frame, tile, tile_endings);
      for (int lane = 0; lane < detail::kTileRays; ++lane) {
        if ((table_.valid[tile] >> lane & 1) == 0) continue;
        endings[table_.ray_index(tile, lane)] = tile_endings[static_cast<std::size_t>(lane)];
      }
    }
  }

  /// Kept tile by tile: sorting into pixels is not tracing.
  void run(std::span<const Pose> poses, ThreadPool& pool) override {
    pool.for_each_chunk(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
      thread_local std::vector<Ending> endings;
      endings.resize(table_.tile_count * detail::kTileRays);
      for (std::size_t p = begin; p < end; ++p) {
        const detail::PoseFrame frame = frame_of(poses[p]);
        for (std::size_t tile = 0; tile < table_.tile_count; ++tile) {
          const std::span<Ending, detail::kTileRays> out(&endings[tile * detail::kTileRays],
                                                         detail::kTileRays);
          tracer_(grid_, table_, frame, tile, out);
        }
      }
    });
  }

 private:
  [[nodiscard]] detail::PoseFrame frame_of(const Pose& T_world_camera) const {
    const Pose T_grid_camera = T_grid_world_ * T_world_camera;
    const Eigen::Vector3d origin = T_grid_camera.translation() / voxel_size_ - base_;
    const Eigen::Matrix3d R = T_grid_camera.rotation();
    detail::PoseFrame frame;
    for (int r = 0; r < 3; ++r) {
      frame.origin[static_cast<std::size_t>(r)] = static_cast<float>(origin[r]);
      for (int c = 0; c < 3; ++c) {
        frame.rotation[static_cast<std::size_t>(3 * r + c)] = static_cast<float>(R(r, c));
      }
    }
    frame.min_range = min_range_;
    frame.max_range = max_range_;
    return frame;
  }

  DenseGrid grid_;
  detail::TileTable table_;
  DenseTileTracer tracer_;
  Pose T_grid_world_;
  double voxel_size_;  ///< [m]
  Eigen::Vector3d base_;
  float min_range_;  ///< [voxel]
  float max_range_;  ///< [voxel]
};

}  // namespace

std::unique_ptr<TraceMethod> make_dense_dda(const TraceTask& task) {
  return std::make_unique<DenseDda>(task);
}

}  // namespace viewgain::bench
