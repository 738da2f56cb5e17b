// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "readings.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// The support plane in a camera's frame: points p with normal · p = offset.
struct CameraPlane {
  Eigen::Vector3d normal;  ///< unit, up in the world
  double offset = 0;       ///< [m]; negative where the camera stands above the plane

  /// The plane world z = `height` [m].
  CameraPlane(double height, const Pose& T_world_camera);
};

/// One sensor's pixels: where they look and what the current frame says there, in the camera's
/// frame.
class FramePixels : public Readings {
 public:
  /// Undoes the lens distortion of every pixel once.
  explicit FramePixels(const Sensor& sensor);

  /// By which the pose of the next frames may be off, beside the sensor's own.
  void set_pose_sigma(const PoseSigma& sigma);

  /// Sorts the frame's pixels into the kinds and computes what follows from the readings alone.
  /// cosθ = amplitude · range² where the frame has amplitudes, else cos_incidence(). With `tapered`
  /// false crossings keep their weight up to the reading. Readings of the frame's known
  /// depth, and those below `plane` or less than 3 σ above it, are on_known. The frame must have
  /// the camera's size.
  void load(const DepthFrame& frame, bool tapered, ThreadPool& pool,
            const std::optional<CameraPlane>& plane = {});

  /// Cosine of the angle between a reading's ray and the normal of its 3×3 neighbourhood: the cross
  /// product of the sums, over rows and over columns, of differences across the pixel (one-sided at
  /// the pixel itself if there is no such pair). Neighbours that are no readings, or whose depth
  /// differs by more than a surface at the least cosine of the noise models would explain, do not
  /// count. 1 where no normal is left.
  [[nodiscard]] double cos_incidence(int u, int v) const;

 private:
  PoseSigma own_pose_sigma_;
  std::vector<double> depths_;  ///< of readings, else NaN; with a border of one pixel
};

}  // namespace viewgain::detail
