// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain {

/// Aligns frames of one scene whose reported poses are slightly wrong. Each new frame is aligned
/// with the earlier frames, then all frames are aligned together. Later frames therefore correct
/// earlier ones, and doubtful frames are tried again. The first frame's pose is fixed.
/// Alternatively, aligns one frame with a map. apps/planner/src/registration/align_frames.cpp
/// describes the method.
///
/// Only readings in the workspace count; flying pixels, known obstacles and the support plane are
/// ignored. A frame contradicts the others if it shows surface in their free space, or sees past
/// their surface. It is refused if it does so at its best fit and at all likely poses.
///
/// Thread safety: no other member may run during add(); const members may run from many threads at
/// once. Bit-identical for any number of threads.
class VIEWGAIN_EXPORT FrameAlignment {
 public:
  /// `map`: settings of the map to which frames are added, or with which they are compared. The
  /// constructor removes the lens distortion once, for all frames. Throws Error(invalid_argument)
  /// naming the value if the sensor, an obstacle or the filter is invalid.
  FrameAlignment(const Sensor& sensor, const ScorerConfig& map, const ExecConfig& exec = {});
  ~FrameAlignment();
  FrameAlignment(FrameAlignment&&) noexcept;
  FrameAlignment& operator=(FrameAlignment&&) noexcept;

  /// Adds a frame; the result is valid until the next call. A refused frame moves no other frame; a
  /// frame with too little overlap stays as reported until other frames show the same surface.
  /// Covariances are relative to the first frame, whose covariance is zero. `sigma`: uncertainty of
  /// the reported pose. Throws Error(invalid_argument), and changes nothing, for a frame of a wrong
  /// size, a pose that is not rigid to within 1e-3, a sigma that is not positive and finite, or
  /// invalid settings of the map's grid. Cost: 100 bytes per measured depth; time grows with
  /// (number of frames)².
  const FrameRegistration& add(DepthFrame frame, const Pose& T_reported,
                               const PoseSigma& sigma = kUsualPoseSigma);

  /// Current results for all frames, in order. The first frame defines the world and counts as
  /// registered. Valid until the next add().
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const;

  /// Aligns a frame with a map, independently of add(). The first frame of an empty map stays as
  /// reported, with zero covariance. Throws whatever add() throws. Cost: fused_points() of the part
  /// that the frame can show, and 10 to 60 ms on two cores.
  [[nodiscard]] FrameRegistration register_frame(const BeliefGrid& grid, DepthFrame frame,
                                                 const Pose& T_reported,
                                                 const PoseSigma& sigma = kUsualPoseSigma) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
