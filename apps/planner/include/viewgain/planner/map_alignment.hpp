// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/jump_edge_filter.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/planner/align_frames.hpp"
#include "viewgain/planner/map_model.hpp"
#include "viewgain/raycast/obstacle_view.hpp"

namespace viewgain {

/// Frames aligned with one another (FrameAlignment) as a map takes them: without flying pixels,
/// known obstacles and the support plane, in its workspace.
///
/// Thread safety: nothing may run beside add(). Cost: that of FrameAlignment, and some passes over
/// the pixels of each frame.
class VIEWGAIN_EXPORT MapAlignment {
 public:
  /// `layout` lays out the map that `map` is the config of; `sigmas` are those of each pose. Throws
  /// Error(invalid_argument) as FrameAlignment, ObstacleView and JumpEdgeFilter.
  MapAlignment(const Sensor& sensor, const BeliefGrid& layout, const MapModelConfig& map,
               const PosePrior& sigmas, const ExecConfig& exec = {});

  /// See FrameAlignment::add().
  const FrameRegistration& add(DepthFrame frame, const Pose& T_reported);
  /// See FrameAlignment::registrations().
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const {
    return alignment_.registrations();
  }

 private:
  std::optional<JumpEdgeFilter> filter_;
  ObstacleView obstacles_;
  PosePrior sigmas_;
  FrameAlignment alignment_;
};

}  // namespace viewgain
