// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {

/// Determines which points of a map's surface its views see unoccluded, for the argument `sees` of
/// estimate_views(). Traces a view on its first query. Thread safety: one call at a time. Cost: one
/// trace per view, then constant time per point.
class VIEWGAIN_EXPORT ViewSight {
 public:
  /// Throws whatever the constructor of GainEvaluator throws. `views`: T_world_camera; queries use
  /// their indices.
  ViewSight(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
            std::span<const Pose> views, const ExecConfig& exec);

  /// Whether the view sees the point [m, world] unoccluded, in the pixel that shows it or one of
  /// its eight neighbours. Something occludes the point only if it is nearer by more than two
  /// voxels plus three standard deviations, so that noise does not hide the point. False outside
  /// the image. `view` is unchecked.
  [[nodiscard]] bool sees(std::size_t view, const Eigen::Vector3d& point);

 private:
  GainEvaluator evaluator_;
  Sensor sensor_;
  std::vector<Pose> views_;
  std::vector<std::optional<std::vector<RayHit>>> traced_;  ///< of each view, in pixel order
};

}  // namespace viewgain
