// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/commands/frames/frame_map.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/planner_mesh/surface_model.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// Recorded frames as they go into a map, and what each brought.
class RecordedViews {
 public:
  /// The map must outlive it. `registrations`: by the frame's index, or nothing where the poses are
  /// taken as the folder says them. `on_contradiction`: what --on-contradiction says.
  explicit RecordedViews(FrameMap& map,
                         std::optional<std::map<std::size_t, FrameRegistration>> registrations = {},
                         std::string on_contradiction = "skip");

  /// Puts a frame into the map, in order; one that was refused stays out of it, and one that cannot
  /// be used is no view either. Throws as FrameMap::add().
  void add(std::size_t index);
  [[nodiscard]] bool empty() const noexcept { return records_.empty(); }
  void add_seconds(const std::string& stage, double seconds) { seconds_[stage] += seconds; }

  /// For what is chosen after it; there must be one.
  [[nodiscard]] ViewRecord& last() noexcept { return records_.back(); }
  /// What run.json holds, without settings and versions. `model` is of the map as it is now.
  [[nodiscard]] Json json(const SurfaceModel& model, const NextViews& next) const;

 private:
  /// Null without one.
  [[nodiscard]] const FrameRegistration* registration(std::size_t index) const;
  [[nodiscard]] bool is_refused(std::size_t index) const;
  [[nodiscard]] Json entry_json(std::size_t index) const;

  FrameMap& map_;
  std::optional<std::map<std::size_t, FrameRegistration>> registrations_;
  std::string on_contradiction_;
  std::size_t asked_ = 0;  ///< frames, whatever became of them
  std::vector<ViewRecord> records_;
  std::vector<double> new_areas_;  ///< one a record [m²]
  IntegrationReport readings_{};   ///< of all frames
  std::size_t jump_edge_removed_ = 0;
  StageSeconds seconds_;
};

}  // namespace viewgain::app
