// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/obstacle_view.hpp"

namespace viewgain {

/// Frames registered against a map (FrameRegistrar) before they go into it, as it takes them:
/// without flying pixels, known obstacles and the support plane.
///
/// Thread safety: const members may run from many threads at once.
class VIEWGAIN_EXPORT MapRegistration {
 public:
  /// `map` is the config of the maps. Throws Error(invalid_argument) as FrameRegistrar,
  /// ObstacleView and JumpEdgeFilter.
  MapRegistration(const Sensor& sensor, const MapModelConfig& map, const ExecConfig& exec = {});

  /// See FrameRegistrar::register_frame(). Costs fused_points() besides, of the part of the grid
  /// that the frame may show.
  [[nodiscard]] FrameRegistration register_frame(const BeliefGrid& grid, DepthFrame frame,
                                                 const PosePrior& prior) const;

 private:
  Sensor sensor_;
  std::vector<Eigen::Vector3d> rays_;
  RegistrationConfig config_;
  std::optional<JumpEdgeFilter> filter_;
  ObstacleView obstacles_;
  ExecConfig exec_;
  FrameRegistrar registrar_;
};

}  // namespace viewgain
