// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/map_registration.hpp"

#include "registration/registration_config.hpp"
#include "viewgain/grid/fused_points.hpp"

namespace viewgain {

MapRegistration::MapRegistration(const Sensor& sensor, const MapModelConfig& map,
                                 const PosePrior& sigmas, const ExecConfig& exec)
    : obstacles_(map.obstacles, sensor, exec),
      sigmas_(sigmas),
      exec_(exec),
      registrar_(sensor, detail::registration_config(map), exec) {
  if (map.jump_edges) filter_.emplace(sensor.camera, *map.jump_edges);
}

FrameRegistration MapRegistration::register_frame(const BeliefGrid& grid, DepthFrame frame,
                                                  const Pose& T_reported) const {
  if (filter_) filter_->apply(frame);
  obstacles_.mark(frame, T_reported);
  PosePrior prior = sigmas_;
  prior.T_world_camera = T_reported;
  return registrar_.register_frame(grid, fused_points(grid, {}, exec_), frame, prior);
}

}  // namespace viewgain
