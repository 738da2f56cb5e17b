// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/core/triangle_mesh.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {

/// All obstacles as one mesh: first the boxes, with twelve triangles each, then the meshes. Throws
/// Error(invalid_argument) for invalid obstacles. Cost: a copy of the meshes.
[[nodiscard]] VIEWGAIN_EXPORT TriangleMesh mesh_of(const Obstacles& obstacles);

/// Finds the pixels of a camera that show known obstacles, such as the walls of a bin, so that the
/// obstacles do not become part of the map.
///
/// Thread safety: one call at a time.
class VIEWGAIN_EXPORT ObstacleView {
 public:
  /// Computes the rays of all pixels once. Throws Error(invalid_argument) for an invalid sensor or
  /// invalid obstacles, and Error(backend) if Embree fails.
  ObstacleView(const Obstacles& obstacles, const Sensor& sensor, const ExecConfig& exec = {});
  ~ObstacleView();
  ObstacleView(ObstacleView&&) noexcept;
  ObstacleView& operator=(ObstacleView&&) noexcept;

  /// Sets DepthFrame::known_depth for a frame from T_world_camera. It is the depth of the first
  /// obstacle on each pixel's ray, minus a margin of kKnownSigmas standard deviations along the
  /// obstacle's normal. It is left empty if there are no obstacles. Throws Error(invalid_argument)
  /// if the pose is not rigid within 1e-3. Also throws whatever check_frame_size() throws. Cost:
  /// about 0.2 µs per pixel and thread.
  void mark(DepthFrame& frame, const Pose& T_world_camera) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
