// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/frame_agreement.hpp"
#include "viewgain/raycast/suspect_frames.hpp"

namespace viewgain {

/// Whether the frames of a map fit one another.
struct VIEWGAIN_EXPORT FrameConsistency {
  std::vector<FrameContradiction> frames{};  ///< one per frame in the map, in their order
  std::size_t in_free = 0;     ///< of all their readings, those that others saw as free
  std::size_t seen_past = 0;   ///< of readings of earlier frames, those that later ones see past
  double share_in_free = 0;    ///< of all their readings, those that others saw as free
  double share_seen_past = 0;  ///< of readings of earlier frames, those that later ones see past
  /// Median over the frames of FrameContradiction's [m]; NaN if no frame could be compared.
  double displacement = 0;
  double expected = 0;  ///< likewise
  /// Which frames contradict the others, ascending; empty unless something is suspected.
  std::vector<std::size_t> contradicting{};
  Suspicion suspicion{};  ///< the likely cause; its kind is empty where the frames agree
};

/// Collects, while frames go into a map, what tells whether they fit one another.
/// Thread safety: one call at a time. Cost: 0.4 ms a frame; keeps a dozen images.
class VIEWGAIN_EXPORT FrameCheck {
 public:
  /// `support_plane`: IntegrationConfig's. Throws Error(invalid_argument) if the sensor is not
  /// valid.
  explicit FrameCheck(const Sensor& sensor, std::optional<double> support_plane = {});

  /// A frame has come at this pose, whether it can be used or not. Ignores one of another size.
  void see(const DepthFrame& frame, const Pose& T_world_camera);
  /// A frame is about to go into the map, as FrameAgreement::look().
  void look(const BeliefGrid& before, const DepthFrame& frame, const Pose& T_world_camera,
            const PoseSigma& pose_sigma = {});

  /// What the frames so far come to, by the map with all of them. Cost: suspect_frames().
  [[nodiscard]] FrameConsistency result(const BeliefGrid& after) const;

 private:
  Sensor sensor_;
  std::optional<double> support_plane_;
  FrameAgreement agreement_;
  std::vector<Pose> sequence_;  ///< of all frames that have come
  std::vector<DepthFrame> kept_;
  std::vector<std::size_t> places_;  ///< of those in the sequence
  std::size_t keep_every_ = 1;
};

/// "3, 5-9" for frames 3 and 5 to 9, which are in ascending order.
[[nodiscard]] VIEWGAIN_EXPORT std::string ranges_text(const std::vector<std::size_t>& numbers);

}  // namespace viewgain
