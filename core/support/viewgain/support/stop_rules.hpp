// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "viewgain/core/export.hpp"
#include "viewgain/core/planning.hpp"

namespace viewgain {

/// State of the stopping rules (PlanningConfig) during a run, for saving and continuing the run. A
/// value type. Gains are in nats, with Criterion::trace in m².
struct VIEWGAIN_EXPORT StopMemory {
  std::size_t views = 0;             ///< number of views taken
  std::size_t idle_views = 0;        ///< number of consecutive idle views up to now
  double entropy_removed = 0;        ///< ModelProgress::entropy_removed after the last view
  std::uint64_t unknown_voxels = 0;  ///< ModelProgress::unknown_voxels after the last view
  std::size_t decisions = 0;         ///< number of decisions
  /// Decision::gain_per_voxel of the first decision with a gain above 0. NaN: none yet, or
  /// PlanningConfig::stop_gain is absolute.
  double first_gain_per_voxel = std::numeric_limits<double>::quiet_NaN();
  /// Decision::best_area divided by the surface area, for the last three decisions. Decision i is
  /// at index i % 3.
  std::array<double, 3> area_shares{};
  /// Decision::area of the view that was chosen last [m²].
  double promised_area = std::numeric_limits<double>::quiet_NaN();
  double promised_gain = std::numeric_limits<double>::quiet_NaN();  ///< its Decision::gain
  std::size_t broken_promises = 0;  ///< number of consecutive ones up to now
};

/// The stopping rules of active_view_planning(), for other loops. Thread safety: one call at a
/// time. Members other than the constructor do not check their arguments, and take constant time.
class VIEWGAIN_EXPORT StopRules {
 public:
  /// `memory` is the state of the run to continue. Throws Error(invalid_argument) if max_views is 0
  /// or a limit is not finite.
  explicit StopRules(const PlanningConfig& config, const StopMemory& memory = {});

  /// Call it when a view is in the model. Returns the first of coverage, max_views, idle and
  /// promises that applies.
  [[nodiscard]] std::optional<StopReason> after_view(const ModelProgress& progress);

  /// Call it after the choice of the next view. If no candidate was chosen, returns no_candidates
  /// or unreachable. Otherwise returns gain, area or cost if the rule applies. `surface_area` [m²]
  /// is that of ModelProgress.
  [[nodiscard]] std::optional<StopReason> after_decision(
      const std::optional<DecisionMaking::Decision>& decision, const Proposal& proposal,
      double surface_area);

  /// The state of the rules.
  [[nodiscard]] const StopMemory& memory() const noexcept { return memory_; }

 private:
  [[nodiscard]] bool brought_nothing(const ModelProgress& now) const;
  void hold_against_promise(const ModelProgress& now);
  [[nodiscard]] bool stops_for_gain(double gain_per_voxel);
  [[nodiscard]] bool stops_for_area(double share);

  PlanningConfig config_;
  StopMemory memory_;
};

/// Returns unreachable if candidates were dropped as unreachable, otherwise no_candidates. Constant
/// time.
[[nodiscard]] VIEWGAIN_EXPORT StopReason nowhere_to_go(const Proposal& proposal);

}  // namespace viewgain
