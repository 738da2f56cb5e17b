// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains of the user's own.
#include "viewgain/raycast/view_measure.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

#include "gain_evaluator_impl.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {

ViewMeasure::~ViewMeasure() = default;

double GainEvaluator::Impl::measure(const Pose& T_world_camera, const ViewMeasure& own,
                                    Lease& lease) const {
  ViewGain view;
  const auto frame = open_view(T_world_camera, view);
  if (!frame) return view.gain;
  const detail::TileTable& table = tracer.table();
  const Eigen::Matrix3d R_world_grid = data.snapshot.T_world_grid.rotation();
  auto& [accumulator, bins, hits] = lease.get();
  hits.clear();
  tracer.trace(*frame, bins, [&](std::size_t number, const detail::RayTile& tile) {
    for (std::uint32_t left = tile.hit; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const std::uint32_t primitive = tile.primitive[lane], offset = tile.offset[lane];
      const SnapshotLeaf* leaf = data.occupied_leaf(primitive, offset);
      const Eigen::Vector3d d =
          R_world_grid * Eigen::Vector3d(tile.dx[lane], tile.dy[lane], tile.dz[lane]).normalized();
      hits.push_back(
          {.voxel = data.voxel_index(primitive, offset),
           .state = leaf != nullptr ? VoxelState::occupied : VoxelState::unknown,
           .belief = leaf != nullptr && leaf->beliefs ? leaf->beliefs->find(offset) : nullptr,
           .ray = table.ray_index(number, lane),
           .range = static_cast<double>(tile.range[lane]) * data.snapshot.voxel_size,
           .direction = {d.x(), d.y(), d.z()}});
    }
  });
  return own.measure(T_world_camera, hits);
}

std::size_t GainEvaluator::evaluate(std::span<const Pose> T_world_camera,
                                    const ViewMeasure& measure, std::span<double> results,
                                    const BatchControl& control) const {
  if (T_world_camera.size() != results.size()) {
    throw Error(ErrorCode::invalid_argument, std::to_string(T_world_camera.size()) +
                                                 " poses but room for " +
                                                 std::to_string(results.size()) + " results");
  }
  std::fill(results.begin(), results.end(), std::numeric_limits<double>::quiet_NaN());
  return impl_->for_each_pose(results.size(), control, [&](std::size_t i, Impl::Lease& lease) {
    results[i] = impl_->measure(T_world_camera[i], measure, lease);
  });
}

}  // namespace viewgain
