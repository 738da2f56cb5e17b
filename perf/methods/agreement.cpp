// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "agreement.hpp"

#include <vector>

#include "oracle/rays.hpp"

namespace viewgain::bench {
namespace {

RayHit hit_of(const oracle::DenseMap& map, Ending ending) {
  if (ending == kMiss) return {};
  const int yz = map.dims.y * map.dims.z;
  const Index3 voxel{map.min_index.x + ending / yz, map.min_index.y + ending % yz / map.dims.z,
                     map.min_index.z + ending % map.dims.z};
  const bool occupied = map.state(voxel) == VoxelState::occupied;
  return {occupied ? RayHit::Kind::occupied : RayHit::Kind::unknown, voxel, 0};
}

Ending ending_of(const oracle::DenseMap& map, const RayHit& hit) {
  return hit.kind == RayHit::Kind::none ? kMiss : static_cast<Ending>(map.position(hit.voxel));
}

std::vector<oracle::Ray> full_rays(const TraceTask& task, const Pose& pose) {
  return oracle::view_rays(task.map.T_world_grid, task.map.voxel_size, task.sensor.camera, 1, pose);
}

}  // namespace

OracleEndings::OracleEndings(const TraceTask& task, ThreadPool& pool)
    : task_(task),
      limits_(oracle::limits_of(task.map, task.sensor, {})),
      rays_per_pose_(task.sensor.camera.ray_table().size()),
      endings_(task.poses.size() * rays_per_pose_) {
  pool.for_each_chunk(task.poses.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::vector<oracle::Ray> rays = full_rays(task, task.poses[p]);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        endings_[p * rays_per_pose_ + i] =
            ending_of(task.map, oracle::first_hit(task.map, rays[i], limits_));
      }
    }
  });
}

Agreement OracleEndings::compare(const Pose& pose, std::span<const Ending> actual) const {
  const auto p = static_cast<std::size_t>(std::find(task_.poses.begin(), task_.poses.end(), pose) -
                                          task_.poses.begin());
  Agreement result;
  std::vector<oracle::Ray> rays;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ++result.rays;
    if (endings_[p * rays_per_pose_ + i] == actual[i]) {
      ++result.same;
      continue;
    }
    if (rays.empty()) rays = full_rays(task_, pose);
    if (oracle::is_tie(task_.map, rays[i], limits_, hit_of(task_.map, actual[i]))) ++result.ties;
  }
  return result;
}

Agreement OracleEndings::compare(const TraceMethod& method, std::span<const Pose> poses,
                                 ThreadPool& pool) const {
  std::vector<Agreement> parts(poses.size());
  pool.for_each_chunk(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<Ending> endings(method.rays_per_pose());
    for (std::size_t i = begin; i < end; ++i) {
      method.trace(poses[i], endings);
      parts[i] = compare(poses[i], endings);
    }
  });
  Agreement sum;
  for (const Agreement& part : parts) sum += part;
  return sum;
}

Agreement compare_with_oracle(const oracle::DenseMap& map, const Sensor& sensor,
                              const GainConfig& config, const GainEvaluator& evaluator,
                              std::span<const Pose> poses) {
  const oracle::RayLimits limits = oracle::limits_of(map, sensor, config);
  Agreement result;
  for (const Pose& pose : poses) {
    const std::vector<oracle::Ray> rays = oracle::view_rays(
        map.T_world_grid, map.voxel_size, sensor.camera, config.pixel_stride, pose);
    const std::vector<RayHit> hits = evaluator.trace(pose);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ++result.rays;
      if (oracle::same_ending(oracle::first_hit(map, rays[i], limits), hits[i])) {
        ++result.same;
      } else if (oracle::is_tie(map, rays[i], limits, hits[i])) {
        ++result.ties;
      }
    }
  }
  return result;
}

}  // namespace viewgain::bench
