// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/frame_agreement.hpp"
#include "viewgain/raycast/suspect_frames.hpp"

namespace viewgain {

/// How well the frames of a map agree. A reading is one measured depth.
struct VIEWGAIN_EXPORT FrameConsistency {
  std::vector<FrameContradiction> frames{};  ///< one per frame in the map, in order
  /// Number of sampled readings in space that other frames saw as free.
  std::size_t in_free = 0;
  /// Number of readings of earlier frames in space that later frames saw as free.
  std::size_t seen_past = 0;
  double share_in_free = 0;  ///< in_free as a fraction of the sampled readings
  /// seen_past as a fraction of the readings of earlier frames in view.
  double share_seen_past = 0;
  /// Median of FrameContradiction::displacement over the frames [m]; NaN if no frame could be
  /// compared.
  double displacement = 0;
  double expected = 0;  ///< median of FrameContradiction::expected [m]
  /// Indices of frames that contradict the others, ascending; empty unless something is suspected.
  std::vector<std::size_t> contradicting{};
  Suspicion suspicion{};  ///< likely cause of a disagreement; kind is empty if the frames agree
};

/// Decides whether the frames of a map agree, from data that it collects while they are integrated.
/// Thread safety: one call at a time. Cost: 0.4 ms per frame, and memory for about twelve images.
class VIEWGAIN_EXPORT FrameCheck {
 public:
  /// `support_plane` [m] is the height z of a table, as in IntegrationConfig. `exec` is for
  /// result(). Throws Error(invalid_argument) if the sensor is invalid.
  explicit FrameCheck(const Sensor& sensor, std::optional<double> support_plane = {},
                      const ExecConfig& exec = {});

  /// Records a frame and its pose. Call it for every frame, even if it cannot be integrated.
  /// Ignores frames that do not have the sensor's size.
  void see(const DepthFrame& frame, const Pose& T_world_camera);
  /// Calls FrameAgreement::look(). Call it before a frame is integrated; `before` is the map at
  /// that time.
  void look(const BeliefGrid& before, const DepthFrame& frame, const Pose& T_world_camera,
            const PoseSigma& pose_sigma = {});

  /// The result for all frames so far. `after` must be the map with these frames. Cost: that of
  /// suspect_frames().
  [[nodiscard]] FrameConsistency result(const BeliefGrid& after) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  ExecConfig exec_;
  FrameAgreement agreement_;
  std::vector<Pose> sequence_;  ///< poses of all recorded frames
  std::vector<DepthFrame> kept_;
  std::vector<std::size_t> places_;  ///< indices of kept_ in sequence_
  std::size_t keep_every_ = 1;
};

/// Numbers as a text of ranges, such as "3, 5-9". They must be ascending.
[[nodiscard]] VIEWGAIN_EXPORT std::string ranges_text(const std::vector<std::size_t>& numbers);

}  // namespace viewgain
