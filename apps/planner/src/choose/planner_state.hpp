// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/support/stop_rules.hpp"

namespace viewgain::detail {

/// What a planner remembers beside its map. A value type.
struct PlannerState {
  double seen_area = 0;                 ///< the sum of what the views showed of new surface [m²]
  FrameCounts frames;                   ///< that were added or dropped
  std::vector<Pose> reached;            ///< commanded, and the camera got there
  std::vector<Pose> missed;             ///< commanded, and it did not
  std::size_t first_views = 0;          ///< of the map that it began with
  std::optional<Pose> last_pose;        ///< where the camera is: the last pose that was told
  std::vector<Pose> planned;            ///< of a plan, still to be taken, in its order
  std::optional<Pose> promised;         ///< the best of the last ranking since the last view
  StopMemory before_choice;             ///< of the rules, as the last view left them
  StopMemory after_choice;              ///< and as the last ranking did
  std::optional<StopReason> of_view;    ///< why to end since the last view
  std::optional<StopReason> of_choice;  ///< and since the last proposal or ranking
};

/// One line an entry; exact.
[[nodiscard]] std::string text_of(const PlannerState& state);
/// Throws Error(format), naming `name` and the line.
[[nodiscard]] PlannerState state_of(const std::string& name, std::string_view text);

}  // namespace viewgain::detail
