// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/map_alignment.hpp"

#include "registration/registration_config.hpp"

namespace viewgain {

MapAlignment::MapAlignment(const Sensor& sensor, const BeliefGrid& layout,
                           const MapModelConfig& map, const PosePrior& sigmas,
                           const ExecConfig& exec)
    : obstacles_(map.obstacles, sensor, exec),
      sigmas_(sigmas),
      alignment_(sensor, layout, detail::registration_config(map), exec) {
  if (map.jump_edges) filter_.emplace(sensor.camera, *map.jump_edges);
}

const FrameRegistration& MapAlignment::add(DepthFrame frame, const Pose& T_reported) {
  if (filter_) filter_->apply(frame);
  obstacles_.mark(frame, T_reported);
  PosePrior prior = sigmas_;
  prior.T_world_camera = T_reported;
  return alignment_.add(frame, prior);
}

}  // namespace viewgain
