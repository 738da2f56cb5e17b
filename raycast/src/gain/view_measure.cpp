// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains of the user's own.
#include "viewgain/raycast/view_measure.hpp"

#include <algorithm>
#include <limits>

#include "batch_loop.hpp"
#include "gain_evaluator_impl.hpp"

namespace viewgain {
namespace {

// Lists the hits of a view and asks the user's measure what they are worth; throws what it throws.
struct MeasureConsumer {
  const detail::ViewDriver& driver;
  const Eigen::Matrix3d& R_world_grid;
  const Pose& T_world_camera;
  const ViewMeasure& measure;
  std::vector<ViewHit>& hits;

  void begin() { hits.clear(); }
  void add(std::size_t number, const detail::RayTile& tile) {
    const detail::SceneData& scene = driver.scene();
    detail::for_each_lane(tile.hit, [&](int lane) {
      const std::uint32_t primitive = tile.primitive[lane], offset = tile.offset[lane];
      const SnapshotLeaf* leaf = scene.occupied_leaf(primitive, offset);
      const Eigen::Vector3d d =
          R_world_grid * Eigen::Vector3d(tile.dx[lane], tile.dy[lane], tile.dz[lane]).normalized();
      hits.push_back(
          {.voxel = scene.voxel_index(primitive, offset),
           .state = leaf != nullptr ? VoxelState::occupied : VoxelState::unknown,
           .belief = leaf != nullptr && leaf->beliefs ? leaf->beliefs->find(offset) : nullptr,
           .ray = driver.tracer().table().ray_index(number, lane),
           .range = static_cast<double>(tile.range[lane]) * scene.snapshot.voxel_size,
           .direction = {d.x(), d.y(), d.z()}});
    });
  }
  void finish(ViewGain& result) { result.gain = measure.measure(T_world_camera, hits); }
};

}  // namespace

ViewMeasure::~ViewMeasure() = default;

std::size_t GainEvaluator::evaluate(std::span<const Pose> T_world_camera,
                                    const ViewMeasure& measure, std::span<double> results,
                                    const BatchControl& control) const {
  detail::check_room(T_world_camera.size(), results.size());
  std::fill(results.begin(), results.end(), std::numeric_limits<double>::quiet_NaN());
  const detail::ViewDriver& driver = impl_->driver;
  const Eigen::Matrix3d R_world_grid = driver.scene().snapshot.T_world_grid.rotation();
  return detail::for_each_pose(driver, results.size(), control,
                               [&](std::size_t i, detail::ViewDriver::Lease& lease) {
                                 MeasureConsumer consumer{driver, R_world_grid, T_world_camera[i],
                                                          measure, lease.workspace().view_hits};
                                 results[i] = driver.view(T_world_camera[i], lease, consumer).gain;
                               });
}

}  // namespace viewgain
