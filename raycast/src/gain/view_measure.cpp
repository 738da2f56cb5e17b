// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Gains of the user's own.
#include "viewgain/raycast/view_measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "gain_evaluator_impl.hpp"
#include "viewgain/support/belief_block.hpp"

namespace viewgain {
namespace {

// Lists the hits of a view and asks the user's measure what they are worth; throws what it throws.
struct MeasureConsumer {
  const detail::ViewDriver& driver;
  const Eigen::Matrix3d& R_world_grid;
  const Pose& T_world_camera;
  const ViewMeasure& measure;
  std::vector<ViewMeasure::Hit>& hits;

  void begin() { hits.clear(); }
  void add(std::size_t number, const detail::RayTile& tile) {
    const detail::SceneData& scene = driver.scene();
    detail::for_each_lane(tile.hit, [&](int lane) {
      const std::uint32_t primitive = tile.primitive[lane], offset = tile.offset[lane];
      const GridSnapshot::Leaf* leaf = scene.occupied_leaf(primitive, offset);
      const Eigen::Vector3d d =
          R_world_grid * Eigen::Vector3d(tile.dx[lane], tile.dy[lane], tile.dz[lane]).normalized();
      hits.push_back(
          {.voxel = scene.voxel_index(primitive, offset),
           .state = leaf != nullptr ? VoxelState::occupied : VoxelState::unknown,
           .belief = leaf != nullptr && leaf->beliefs ? leaf->beliefs->find(offset) : nullptr,
           .ray = driver.tracer().table().image_ray_index(number, lane),
           .range = static_cast<double>(tile.range[lane]) * scene.snapshot.voxel_size,
           .direction = {d.x(), d.y(), d.z()}});
    });
  }
  void finish(ViewGain& result) { result.gain = measure.measure(T_world_camera, hits); }
};

// Lists what the rays of a view pass.
void list_runs(const detail::ViewDriver& driver, const detail::PoseFrame& frame,
               detail::Workspace& workspace) {
  const GridSnapshot& snapshot = driver.scene().snapshot;
  const Eigen::Matrix3d R_world_grid = snapshot.T_world_grid.rotation();
  const double V = snapshot.voxel_size;
  const detail::SurfaceView& walk = driver.ordered();
  const HazardField& hazard = driver.scene().hazard_field();
  driver.tracer().prepare(frame, workspace.sweep);
  std::vector<RunMeasure::Run>& runs = workspace.view_runs;
  runs.clear();
  walk.for_each_visited(
      frame, workspace,
      [&](std::size_t number, const detail::RayTile& rays,
          const std::vector<detail::VoxelVisit>& visits) {
        RunMeasure::Run run;
        for (auto visit = visits.begin(); visit != visits.end(); ++visit) {
          if (visit == visits.begin() || visit->lane != (visit - 1)->lane) {
            const auto lane = static_cast<int>(visit->lane);
            const Eigen::Vector3d d =
                R_world_grid *
                Eigen::Vector3d(rays.dx[lane], rays.dy[lane], rays.dz[lane]).normalized();
            run.ray = driver.tracer().table().image_ray_index(number, lane);
            run.direction = {d.x(), d.y(), d.z()};
          }
          const bool occupied = visit->state == detail::BrickTable::kOccupiedVoxel;
          run.voxel = walk.voxel_at(visit->x, visit->y, visit->z);
          run.state = occupied ? VoxelState::occupied : VoxelState::unknown;
          run.begin = static_cast<double>(visit->begin) * V;
          run.end = occupied ? run.begin : static_cast<double>(visit->end) * V;
          run.rate = occupied ? 0.0 : static_cast<double>(hazard.rate(run.voxel));
          run.belief = nullptr;
          if (const GridSnapshot::Leaf* leaf = occupied ? snapshot.find_leaf(run.voxel) : nullptr) {
            if (leaf->beliefs) run.belief = leaf->beliefs->find(block_offset(run.voxel));
          }
          runs.push_back(run);
        }
      });
}

}  // namespace

ViewMeasure::~ViewMeasure() = default;
RunMeasure::~RunMeasure() = default;

double detail::measured(const ViewDriver& driver, const Pose& T_world_camera,
                        ViewDriver::Lease& lease, const ViewMeasure& measure) {
  const Eigen::Matrix3d R_world_grid = driver.scene().snapshot.T_world_grid.rotation();
  MeasureConsumer consumer{driver, R_world_grid, T_world_camera, measure,
                           lease.workspace().view_hits};
  return driver.view(T_world_camera, lease, consumer).gain;
}

double detail::measured(const ViewDriver& driver, const Pose& T_world_camera,
                        ViewDriver::Lease& lease, const RunMeasure& measure) {
  ViewGain result;
  const auto frame = driver.open(T_world_camera, result);
  if (!frame) return result.gain;
  list_runs(driver, *frame, lease.workspace());
  return measure.measure(T_world_camera, lease.workspace().view_runs);
}

namespace {

template <typename Measure>
std::size_t measure_all(const detail::ViewDriver& driver, std::span<const Pose> T_world_camera,
                        std::span<double> results, const Measure& measure,
                        const BatchControl& control) {
  detail::check_room(T_world_camera.size(), results.size());
  std::fill(results.begin(), results.end(), std::numeric_limits<double>::quiet_NaN());
  return detail::for_each_pose(
      driver, results.size(), control, [&](std::size_t i, detail::ViewDriver::Lease& lease) {
        results[i] = detail::measured(driver, T_world_camera[i], lease, measure);
      });
}

}  // namespace

std::size_t GainEvaluator::evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                                    const ViewMeasure& measure, const BatchControl& control) const {
  return measure_all(impl_->driver, T_world_camera, results, measure, control);
}

std::size_t GainEvaluator::evaluate(std::span<const Pose> T_world_camera, std::span<double> results,
                                    const RunMeasure& measure, const BatchControl& control) const {
  (void)impl_->driver.ordered();  // its errors on this thread
  return measure_all(impl_->driver, T_world_camera, results, measure, control);
}

}  // namespace viewgain
