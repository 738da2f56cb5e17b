// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "suspicions.hpp"

#include <algorithm>
#include <iterator>
#include <string>

namespace viewgain::python {

void warn(std::span<const Suspicion> suspicions) {
  std::string text;
  for (const Suspicion& suspicion : suspicions) {
    if (!suspicion.kind.empty()) text += (text.empty() ? "" : "; ") + suspicion.what;
  }
  if (text.empty()) return;
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

Suspicion suspicion_of_poses(const std::shared_ptr<const VoxelScene>& scene, const Sensor& sensor,
                             std::span<const Pose> poses) {
  constexpr std::size_t kFew = 10;  // so few poses may all look elsewhere on purpose
  if (!mostly_look_away(scene->snapshot(), sensor, poses)) return {};
  std::vector<Pose> rigid;
  std::copy_if(poses.begin(), poses.end(), std::back_inserter(rigid),
               [](const Pose& pose) { return rigid_pose(pose).has_value(); });
  Suspicion suspicion = suspect_poses(scene, sensor, rigid);
  return suspicion.kind == "no_voxel" && rigid.size() < kFew ? Suspicion() : suspicion;
}

Suspicion suspicion_of_frame(const Sensor& sensor, const DepthFrame& frame,
                             const Pose& T_world_camera, const BeliefGrid& grid,
                             const IntegrationReport& counts) {
  if (20 * counts.readings_inside > counts.readings) return {};
  return suspect_frame(sensor, frame, T_world_camera, grid);
}

std::vector<Suspicion> suspicions_of_set_up(const ViewScorer& scorer, const ReachRegion& reach) {
  const Sensor& sensor = scorer.sensor();
  const BeliefGrid& grid = scorer.grid();
  const ScorerConfig& config = scorer.config();
  std::vector<Suspicion> all = suspect_sensor(sensor, grid.voxel_size());
  all.push_back(suspect_workspace(grid, sensor));
  const auto add_obstacle = [&](const Box& bounds) {
    all.push_back(suspect_obstacle(bounds, grid, sensor));
    if (!all.back().kind.empty()) all.back().what = "an obstacle " + all.back().what;
  };
  const Obstacles& obstacles = config.obstacles;
  for (const Box& box : obstacles.boxes) add_obstacle(box);
  for (const TriangleMesh& mesh : obstacles.meshes) add_obstacle(obstacle_bounds(mesh));
  if (const auto& plane = config.support_plane) {
    all.push_back(suspect_support_plane(*plane, grid, sensor));
  }
  all.push_back(suspect_reach(reach, grid, sensor));
  if (const auto& size = config.hazard.object_size) {
    all.push_back(suspect_object_size(*size, grid));
  }
  all.push_back(suspect_clearance(config.clearance));
  return all;
}

}  // namespace viewgain::python
