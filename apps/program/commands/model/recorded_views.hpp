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

/// Records for frames that go into a map, with the effect of each.
class RecordedViews {
 public:
  /// The map must outlive this object. `registrations`: by frame index; empty to use the folder's
  /// poses. `on_contradiction`: the value of --on-contradiction.
  explicit RecordedViews(FrameMap& map,
                         std::optional<std::map<std::size_t, FrameRegistration>> registrations = {},
                         std::string on_contradiction = "skip");

  /// Puts the next frame into the map. A frame that was refused or cannot be used is left out and
  /// is not a view. Throws like FrameMap::add().
  void add(std::size_t index);
  [[nodiscard]] bool empty() const noexcept { return records_.empty(); }
  void add_seconds(const std::string& stage, double seconds) { seconds_[stage] += seconds; }

  /// The last record, to add what is chosen next; there must be one.
  [[nodiscard]] ViewRecord& last() noexcept { return records_.back(); }
  /// Contents of run.json without settings and versions. `model` must show the current map.
  [[nodiscard]] Json json(const SurfaceModel& model, const NextViews& next) const;

 private:
  /// Null if the frame has no registration.
  [[nodiscard]] const FrameRegistration* registration(std::size_t index) const;
  [[nodiscard]] bool is_refused(std::size_t index) const;
  [[nodiscard]] Json entry_json(std::size_t index) const;

  FrameMap& map_;
  std::optional<std::map<std::size_t, FrameRegistration>> registrations_;
  std::string on_contradiction_;
  std::size_t asked_ = 0;  ///< number of frames, used or not
  std::vector<ViewRecord> records_;
  std::vector<double> new_areas_;  ///< one per record [m²]
  IntegrationReport readings_{};   ///< of all frames
  std::size_t jump_edge_removed_ = 0;
  StageSeconds seconds_;
};

}  // namespace viewgain::app
