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

/// The planner's state in addition to its map. A value type.
struct PlannerState {
  double seen_area = 0;                 ///< sum of the new surface of all views [m²]
  FrameCounts frames;                   ///< number of views added or dropped
  std::vector<Pose> reached;            ///< commanded and reached
  std::vector<Pose> missed;             ///< commanded and not reached
  std::size_t first_views = 0;          ///< views of the initial map
  std::optional<Pose> last_pose;        ///< current camera pose: the last known one
  std::vector<Pose> planned;            ///< remaining views of a plan, in order
  std::optional<Pose> promised;         ///< best view of the last ranking since the last view
  StopMemory before_choice;             ///< state of the rules after the last view
  StopMemory after_choice;              ///< state of the rules after the last ranking
  std::optional<StopReason> of_view;    ///< stop reason since the last view
  std::optional<StopReason> of_choice;  ///< stop reason since the last proposal or ranking
};

/// One line per entry; exact.
[[nodiscard]] std::string text_of(const PlannerState& state);
/// Throws Error(format) with `name` and the line.
[[nodiscard]] PlannerState state_of(const std::string& name, std::string_view text);

}  // namespace viewgain::detail
