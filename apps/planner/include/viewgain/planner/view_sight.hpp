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

/// Which points of a map's surface its views see past everything else in the map: what
/// estimate_views asks for as `sees`. A view is traced when it is first asked about. Thread safety:
/// one call at a time. Cost: a trace a view; then constant time a point.
class VIEWGAIN_EXPORT ViewSight {
 public:
  /// Throws what GainEvaluator's constructor throws. `views`: T_world_camera, in the order of the
  /// numbers by which they are asked about.
  ViewSight(std::shared_ptr<const VoxelScene> scene, const Sensor& sensor,
            std::span<const Pose> views, const ExecConfig& exec);

  /// True if, of the pixel that shows the point and the eight round it, one has nothing that is not
  /// free clearly before the point [m, world]: by more than two voxels and three sigmas of a
  /// reading, since the point's own noise shell hides nothing. False outside the image. `view` is
  /// not checked.
  [[nodiscard]] bool sees(std::size_t view, const Eigen::Vector3d& point);

 private:
  GainEvaluator evaluator_;
  Sensor sensor_;
  std::vector<Pose> views_;
  std::vector<std::optional<std::vector<RayHit>>> traced_;  ///< of each view, in pixel order
};

}  // namespace viewgain
