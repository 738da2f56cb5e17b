// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "non_free_voxels.hpp"
#include "scene/scene_data.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain::detail {

/// Whether much of a view shows what is nearer than the sensor can measure. A coarse bundle of rays
/// starts at the lens; those that end in the map are counted, and of these those within min_range.
/// Immutable; thread safe.
class SightCheck {
 public:
  /// Undoes the lens distortion.
  SightCheck(const Sensor& sensor, double max_near_share);

  /// Of a camera whose rotation is orthonormal. Most views have nothing within min_range, which a
  /// look at the blocks of voxels there tells; else rays are traced until the answer is clear. Rays
  /// that meet an obstacle before a voxel, in single precision, end there.
  [[nodiscard]] bool too_near(const Pose& T_grid_camera, const NonFreeVoxels& voxels,
                              const SceneData& scene) const;

 private:
  /// Rays next to each other, and a cone round them.
  struct Bundle {
    std::size_t first = 0, count = 0;
    Eigen::Vector3d axis;
    double sine = 0, cosine = 1;
  };
  [[nodiscard]] static Bundle bundle_of(const std::vector<Eigen::Vector3d>& rays, std::size_t first,
                                        std::size_t count);

  double min_range_, max_range_, max_near_share_;
  std::vector<Eigen::Vector3d> rays_;  ///< unit directions in the camera's frame, by bundle
  std::vector<Bundle> bundles_;
  Bundle all_;
};

}  // namespace viewgain::detail
