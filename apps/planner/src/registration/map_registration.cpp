// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/map_registration.hpp"

#include "registration/pose_motion.hpp"
#include "registration/registration_config.hpp"
#include "registration/seen_space.hpp"
#include "viewgain/grid/fused_points.hpp"
#include "viewgain/grid/pooling.hpp"

namespace viewgain {
namespace {

constexpr double kReadingMargin =
    10;  // pooling lengths beyond what the frame shows: readings have some

}  // namespace

MapRegistration::MapRegistration(const Sensor& sensor, const MapModelConfig& map,
                                 const ExecConfig& exec)
    : sensor_(sensor),
      rays_(sensor.camera.ray_table()),
      config_(detail::registration_config(map)),
      obstacles_(map.obstacles, sensor, exec),
      exec_(exec),
      registrar_(sensor, config_, exec) {
  if (map.jump_edges) filter_.emplace(sensor.camera, *map.jump_edges);
}

FrameRegistration MapRegistration::register_frame(const BeliefGrid& grid, DepthFrame frame,
                                                  const PosePrior& prior) const {
  check_frame_size(frame, sensor_.camera);
  detail::check(prior);
  if (filter_) filter_->apply(frame);
  obstacles_.mark(frame, prior.T_world_camera);
  const detail::SeenSpace seen(frame, sensor_, rays_, prior, config_.max_sigmas,
                               kReadingMargin * pooling_of(grid.snapshot()).length);
  FusedPointsConfig points;
  points.where = [&](const Eigen::Vector3d& p_world) { return seen.contains(p_world); };
  return registrar_.register_frame(grid, fused_points(grid, points, exec_), frame, prior);
}

}  // namespace viewgain
